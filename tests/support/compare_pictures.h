// How far two pictures are from each other.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "rayshade/image/picture_file.h"

namespace rayshade {

// Where the bits of two pictures (or of the frames of two animations) differ first; empty: nowhere.
std::string difference(const Picture& got, const Picture& expected);
std::string difference(const std::vector<Picture>& got, const std::vector<Picture>& expected);

// Of pictures in 8-bit levels.
struct Distance {
  bool sameSize = false;
  double over1 = 0;            // share of the pixels of which a channel differs by more than 1/255
  double rmse = 0, rmse4 = 0;  // of 255; rmse4: after averaging blocks of 4 x 4
};
Distance distance(const Picture& a, const Picture& b);

}  // namespace rayshade
