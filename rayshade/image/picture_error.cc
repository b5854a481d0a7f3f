// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/picture_error.h"

#include <cmath>

#include "rayshade/image/flip.h"

namespace rayshade {
namespace {

constexpr double kDark = 0.01;  // light below which errors are no longer relative

std::string whereNotFinite(const Picture& picture, const char* which) {
  const auto width = static_cast<std::size_t>(picture.width);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    if (!std::isfinite(picture.pixels[i]))
      return std::string(which) + ": pixel " + std::to_string(i / 3 % width) + " " +
             std::to_string(i / 3 / width) + " is not a finite number";
  return "";
}

std::string sizeOf(const Picture& picture) {
  return std::to_string(picture.width) + " by " + std::to_string(picture.height);
}

}  // namespace

std::string whyNotComparable(const Picture& reference, const Picture& picture) {
  if (reference.width != picture.width || reference.height != picture.height)
    return "the reference has " + sizeOf(reference) + " pixels, the picture " + sizeOf(picture);
  if (reference.pixels.empty()) return "there are no pixels";
  const std::string inReference = whereNotFinite(reference, "reference");
  return inReference.empty() ? whereNotFinite(picture, "picture") : inReference;
}

PictureError pictureError(const Picture& reference, const Picture& picture) {
  PictureError result;
  double relativeSum = 0, squareSum = 0;
  for (std::size_t pixel = 0; pixel < reference.pixels.size() / 3; ++pixel) {
    double ofPixel = 0;
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      const double r = reference.pixels[i], difference = picture.pixels[i] - r;
      const double relative = difference / (std::abs(r) + kDark);
      ofPixel += relative * relative / 3;
      squareSum += difference * difference;
    }
    relativeSum += ofPixel;
    if (pixel > 0 && !(ofPixel > result.worst.mrse)) continue;
    const auto width = static_cast<std::size_t>(reference.width);
    result.worst.x = static_cast<std::int32_t>(pixel % width);
    result.worst.y = static_cast<std::int32_t>(pixel / width);
    result.worst.mrse = ofPixel;
    for (std::size_t c = 0; c < 3; ++c) {
      result.worst.reference[c] = reference.pixels[3 * pixel + c];
      result.worst.picture[c] = picture.pixels[3 * pixel + c];
    }
  }
  const auto pixels = static_cast<double>(reference.pixels.size() / 3);
  result.mrse = relativeSum / pixels;
  result.rmse = std::sqrt(squareSum / (3 * pixels));
  result.flipOfPixels = flipErrors(reference, picture);
  for (double error : result.flipOfPixels) result.flip += error / pixels;
  return result;
}

}  // namespace rayshade
