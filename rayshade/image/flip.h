// LDR-FLIP: how much of the difference of two pictures a viewer sees who flips between them, 0 nothing to 1.
//
// Colours are blurred as the eye blurs them at a number of pixels per degree, and compared in CIELAB; edges and points that
// one picture has and the other has not make differences larger.  Light is linear, sRGB primaries; what a screen
// cannot show is cut off to 0..1.  Beyond the border the outermost pixels go on.
//
// Source of the method and of every constant: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom & Fairchild, FLIP: A
// Difference Evaluator for Alternating Images, Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rayshade/image/picture_file.h"

namespace rayshade {

// A screen 0.7 m wide with 3840 pixels, seen from 0.7 m: the paper's.
inline constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;

// The error of each pixel, row by row; the pictures have the same size and their pixels are finite.
std::vector<double> flipErrors(const Picture& reference, const Picture& picture,
                               double pixelsPerDegree = kPixelsPerDegree);

}  // namespace rayshade
