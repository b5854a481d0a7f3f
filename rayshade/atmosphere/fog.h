// Fog of constant density.
//
//   fog  r g b  hr hg hb          its colour; for each channel the distance after which half of the light is
//   left
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/atmosphere/effect.h"

namespace rayshade {

struct Fog {
  Color color, half;

  static constexpr std::string_view keyword = "fog";
  static constexpr std::string_view examples[] = {".6 .6 .7  20 20 20"};

  static std::optional<Fog> parse(Arguments& in) {
    const Color color = in.color();
    return Fog{color, in.color()};
  }
  Color apply(Color seen, const AirPath& path) const { return veil(seen, color, half, path.distance); }
};

template <class Archive>
void serialize(Archive& archive, Fog& f) {
  archive(f.color, f.half);
}

}  // namespace rayshade
