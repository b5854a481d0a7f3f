// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

// The exponents and the break of the paper's section 4: how colour and feature differences become errors.
constexpr double kColorExponent = 0.7, kFeatureExponent = 0.5;
constexpr double kBreakFrom = 0.4, kBreakTo = 0.95;  // shares of the largest colour difference, of the error
constexpr double kFeatureWidth = 0.082;              // of edges and points                       [degrees]

// Three channels: linear RGB, XYZ relative to white, opponent colours (Y, Cx, Cz), or L, a, b.
using Triple = std::array<double, 3>;

// sRGB primaries, IEC 61966-2-1; white is the image of (1, 1, 1).
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                 {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                 {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double kFromXyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                   {-0.969224334, 1.875930071, 0.041554224},
                                   {0.055639423, -0.204011202, 1.057148933}};

double whiteOf(int row) { return kToXyz[row][0] + kToXyz[row][1] + kToXyz[row][2]; }

// Relative to white.
Triple xyzOf(const Triple& rgb) {
  Triple xyz;
  for (int i = 0; i < 3; ++i)
    xyz[i] = (kToXyz[i][0] * rgb[0] + kToXyz[i][1] * rgb[1] + kToXyz[i][2] * rgb[2]) / whiteOf(i);
  return xyz;
}

Triple opponentOf(const Triple& rgb) {
  const auto [x, y, z] = xyzOf(rgb);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// What a screen can show of an opponent colour, in linear RGB.
Triple shownOf(const Triple& opponent) {
  const double y = (opponent[0] + 16) / 116;
  const Triple xyz = {(y + opponent[1] / 500) * whiteOf(0), y * whiteOf(1),
                      (y - opponent[2] / 200) * whiteOf(2)};
  Triple rgb;
  for (int i = 0; i < 3; ++i)
    rgb[i] =
        std::clamp(kFromXyz[i][0] * xyz[0] + kFromXyz[i][1] * xyz[1] + kFromXyz[i][2] * xyz[2], 0.0, 1.0);
  return rgb;
}

// CIELAB with the chroma of dark colours reduced (Hunt).
Triple labOf(const Triple& rgb) {
  const auto root = [](double t) {
    constexpr double kKnee = 6.0 / 29;
    return t > kKnee * kKnee * kKnee ? elementary::cbrt(t) : t / (3 * kKnee * kKnee) + 4.0 / 29;
  };
  const Triple xyz = xyzOf(rgb);
  const double x = root(xyz[0]), y = root(xyz[1]), z = root(xyz[2]);
  const double l = 116 * y - 16;
  return {l, 0.01 * l * (500 * (x - y)), 0.01 * l * (200 * (y - z))};
}

// HyAB: city-block between lightness and the plane of a and b.
double hyab(const Triple& a, const Triple& b) {
  return std::abs(a[0] - b[0]) + elementary::hypot(a[1] - b[1], a[2] - b[2]);
}

double colorError(const Triple& a, const Triple& b) {
  const double most = elementary::pow(hyab(labOf({0, 1, 0}), labOf({0, 0, 1})), kColorExponent);
  const double difference = elementary::pow(hyab(a, b), kColorExponent), knee = kBreakFrom * most;
  if (difference < knee) return kBreakTo / knee * difference;
  return kBreakTo + (difference - knee) / (most - knee) * (1 - kBreakTo);
}

// A channel of a picture.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;  // row by row
};

// Weights of the neighbours at -radius .. radius.
using Kernel = std::vector<double>;

template <class Weight>
Kernel kernelOf(int radius, const Weight& weight) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(weight(i));
  return kernel;
}

Kernel scaled(Kernel kernel, double by) {
  for (double& weight : kernel) weight *= by;
  return kernel;
}

double sumOf(const Kernel& kernel) {
  double sum = 0;
  for (double weight : kernel) sum += weight;
  return sum;
}

// Positive weights sum to 1, negative ones to -1.
Kernel balanced(Kernel kernel) {
  double above = 0, below = 0;
  for (double weight : kernel) (weight > 0 ? above : below) += weight;
  for (double& weight : kernel) weight /= weight > 0 ? above : -below;
  return kernel;
}

Plane filteredAlong(const Plane& plane, const Kernel& kernel, bool rows) {
  const int radius = static_cast<int>(kernel.size() / 2);
  const int length = rows ? plane.width : plane.height;
  Plane result{plane.width, plane.height, std::vector<double>(plane.values.size())};
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width);
      double sum = 0;
      for (int i = -radius; i <= radius; ++i) {
        const auto at = static_cast<std::size_t>(std::clamp((rows ? x : y) + i, 0, length - 1));
        const std::size_t from =
            rows ? row + at : at * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x);
        sum += kernel[static_cast<std::size_t>(i + radius)] * plane.values[from];
      }
      result.values[row + static_cast<std::size_t>(x)] = sum;
    }
  }
  return result;
}

Plane filtered(const Plane& plane, const Kernel& horizontal, const Kernel& vertical) {
  return filteredAlong(filteredAlong(plane, horizontal, true), vertical, false);
}

// The eye's sensitivity to contrast in one channel: a sum of two Gaussians of the distance in degrees,
// a sqrt(pi / b) exp(-pi^2 d^2 / b).
struct Sensitivity {
  struct Gaussian {
    double a, b;
  };
  std::array<Gaussian, 2> parts;
};
constexpr Sensitivity kSensitivities[3] = {
    {{{{1, 0.0047}, {0, 1e-5}}}}, {{{{1, 0.0053}, {0, 1e-5}}}}, {{{{34.1, 0.04}, {13.5, 0.025}}}}};
constexpr double kWidest = 0.04;

Plane blurred(const Plane& plane, const Sensitivity& sensitivity, double pixelsPerDegree) {
  constexpr double kPi = std::numbers::pi;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixelsPerDegree));
  Plane sum{plane.width, plane.height, std::vector<double>(plane.values.size())};
  double weights = 0;
  for (const auto& [a, b] : sensitivity.parts) {
    if (a == 0) continue;
    const Kernel kernel = kernelOf(radius, [&, b = b](int i) {
      const double degrees = i / pixelsPerDegree;
      return elementary::exp(-kPi * kPi * degrees * degrees / b);
    });
    const double factor = a * std::sqrt(kPi / b), weight = sumOf(kernel);
    const Plane part = filtered(plane, scaled(kernel, factor), kernel);
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += part.values[i];
    weights += factor * weight * weight;
  }
  for (double& value : sum.values) value /= weights;
  return sum;
}

// How strong edges and points are at each pixel of a channel of lightness, 0..1.
struct Features {
  std::vector<double> edges, points;
};

Features featuresOf(const Plane& lightness, double pixelsPerDegree) {
  const double deviation = 0.5 * kFeatureWidth * pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto gauss = [&](int i) { return elementary::exp(-(i * i) / (2 * deviation * deviation)); };
  const Kernel across = balanced(kernelOf(radius, gauss));
  const Kernel edge = balanced(kernelOf(radius, [&](int i) { return -i * gauss(i); }));
  const Kernel point =
      balanced(kernelOf(radius, [&](int i) { return (i * i / (deviation * deviation) - 1) * gauss(i); }));
  const auto strength = [&](const Kernel& kernel) {
    const Plane x = filtered(lightness, kernel, across), y = filtered(lightness, across, kernel);
    std::vector<double> lengths;
    for (std::size_t i = 0; i < x.values.size(); ++i)
      lengths.push_back(elementary::hypot(x.values[i], y.values[i]));
    return lengths;
  };
  return {strength(edge), strength(point)};
}

// What the eye sees of a picture.
struct Seen {
  std::vector<Triple> colors;  // L, a, b after the eye's blur
  Features features;
};

Seen seenOf(const Picture& picture, double pixelsPerDegree) {
  const std::size_t count = picture.pixels.size() / 3;
  std::array<Plane, 3> planes;
  for (Plane& plane : planes) plane = {picture.width, picture.height, std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    Triple rgb;
    for (std::size_t c = 0; c < 3; ++c)
      rgb[c] = std::clamp(static_cast<double>(picture.pixels[3 * i + c]), 0.0, 1.0);
    const Triple opponent = opponentOf(rgb);
    for (std::size_t c = 0; c < 3; ++c) planes[c].values[i] = opponent[c];
  }
  Plane lightness = planes[0];
  for (double& value : lightness.values) value = (value + 16) / 116;

  Seen seen;
  seen.features = featuresOf(lightness, pixelsPerDegree);
  for (std::size_t c = 0; c < 3; ++c) planes[c] = blurred(planes[c], kSensitivities[c], pixelsPerDegree);
  for (std::size_t i = 0; i < count; ++i)
    seen.colors.push_back(labOf(shownOf({planes[0].values[i], planes[1].values[i], planes[2].values[i]})));
  return seen;
}

}  // namespace

std::vector<double> flipErrors(const Picture& reference, const Picture& picture, double pixelsPerDegree) {
  const Seen a = seenOf(reference, pixelsPerDegree), b = seenOf(picture, pixelsPerDegree);
  std::vector<double> errors;
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    const double edges = std::abs(a.features.edges[i] - b.features.edges[i]);
    const double points = std::abs(a.features.points[i] - b.features.points[i]);
    const double feature = elementary::pow(std::max(edges, points) / std::numbers::sqrt2, kFeatureExponent);
    errors.push_back(elementary::pow(colorError(a.colors[i], b.colors[i]), 1 - feature));
  }
  return errors;
}

}  // namespace rayshade
