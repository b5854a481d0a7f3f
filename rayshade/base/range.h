// The ranges of the numbers in a scene.  Each number is checked where it is read, so that no picture has a value that is
// not finite: what stands in no range here may be any finite number.
//
// differs from rayshade4, which takes any number.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "rayshade/base/color.h"

namespace rayshade {

struct Range {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool open = false;  // without its ends

  bool holds(double x) const { return open ? x > least && x < most : x >= least && x <= most; }
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kAnyWholeNumber{-2147483648.0, 2147483647.0};
inline constexpr Range kNotNegative{0};
inline constexpr Range kPositive{0, kAnyNumber.most, true};
inline constexpr Range kPositiveWholeNumber{1, kAnyWholeNumber.most};
inline constexpr Range kFactor{-kMostLight, kMostLight};  // colours, and what they are multiplied by
inline constexpr Range kShare{0, 1};
inline constexpr Range kExponent{-1e9, 1e9};        // of a highlight
inline constexpr Range kFieldOfView{0, 180, true};  // degrees

// "from 0 to 1"
inline std::string describe(const Range& range) {
  std::ostringstream text;
  text.precision(10);
  if (range.open && std::isinf(range.most))
    text << "above " << range.least;
  else if (std::isinf(range.most))
    text << "of at least " << range.least;
  else
    text << (range.open ? "between " : "from ") << range.least << (range.open ? " and " : " to ")
         << range.most;
  return text.str();
}

}  // namespace rayshade
