// What the formats of pictures have in common.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "rayshade/image/picture.h"

namespace rayshade {

inline constexpr std::int32_t kLongestSide = 1'000'000;  // pixels; libpng's own limit

[[noreturn]] inline void failOn(const std::string& file, const std::string& why) {
  throw std::runtime_error(file + ": " + why);
}

// The number of values in a picture; fails unless the file has as many bytes.
inline std::size_t countValues(const Picture& picture, std::size_t bytesPerValue, std::size_t bytes,
                               const std::string& name) {
  const std::size_t count =
      std::size_t{3} * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  if (bytes / bytesPerValue < count) failOn(name, "ends too early");
  return count;
}

}  // namespace rayshade
