// How far a picture is from a reference: what `rayshade-error` says.
//
//   v light of the picture, r that of the reference, linear; means over all pixels and channels
//
//   mrse   mean of (v - r)^2 / (|r| + 0.01)^2     relative: Pharr, Jakob & Humphreys, Physically Based Rendering, imgtool
//   rmse   root of the mean of (v - r)^2          absolute: dark places count little
//   flip   mean of LDR-FLIP                       what a viewer sees, flip.h
//   worst  the pixel with the largest relative error
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "rayshade/image/picture_file.h"

namespace rayshade {

struct PictureError {
  double mrse = 0, rmse = 0, flip = 0;
  struct Worst {
    std::int32_t x = 0, y = 0;  // from the upper left
    double mrse = 0;            // of this pixel
    std::array<float, 3> reference{}, picture{};
  } worst;                           // the first one of several
  std::vector<double> flipOfPixels;  // row by row
};

// What forbids a comparison, e.g. different sizes or a pixel that is not a finite number; empty: nothing.
std::string whyNotComparable(const Picture& reference, const Picture& picture);

// Requires that nothing forbids it.
PictureError pictureError(const Picture& reference, const Picture& picture);

}  // namespace rayshade
