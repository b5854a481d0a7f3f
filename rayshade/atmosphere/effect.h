// What an atmospheric effect is: it changes the colour that a ray brings, outside of all media.
//
//   keyword    the word after `atmosphere`
//   examples   what may follow it: tests and documents read them
//   parse      reads its own arguments
//   apply      the colour seen along a ray that was hit at `end`, `distance` away (infinite: nothing was hit)
//   serialize  its fields, for the wire
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <optional>
#include <string_view>

#include "rayshade/base/archive.h"
#include "rayshade/base/color.h"
#include "rayshade/base/elementary.h"
#include "rayshade/base/vec.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

// A stretch of atmosphere: from `start` to `end`, world space.
struct AirPath {
  Vec3 start, end;
  double distance = 0;  // at most kFarAway
};

template <class E>
concept Effect = Serializable<E> &&
    requires(const E effect, Color seen, const AirPath& path, Arguments& arguments) {
  { E::keyword } -> std::convertible_to<std::string_view>;
  { E::parse(arguments) } -> std::same_as<std::optional<E>>;
  { effect.apply(seen, path) } -> std::same_as<Color>;
  E::examples[0];
};

// What rayshade takes as the distance of a miss.
inline constexpr double kFarAway = 1e14;

// What is left of light after `distance` when half of it is left after `half`: 2^(-distance / half), cut to 0
// below e^-10 as in rayshade.  half = 0: nothing is left.
inline double halving(double distance, double half) {
  if (half < kNegligible) return 0;
  const double exponent = -0.69314718 * distance / half;
  return exponent < -10 ? 0 : elementary::exp(exponent);
}

// Mixes `seen` with the colour of the air by what the air lets through of each channel.
inline Color veil(Color seen, Color air, Color half, double distance) {
  auto channel = [distance](double s, double a, double h) {
    const double left = halving(distance, h);
    return left * s + (1 - left) * a;
  };
  return {channel(seen.r, air.r, half.r), channel(seen.g, air.g, half.g), channel(seen.b, air.b, half.b)};
}

}  // namespace rayshade
