// Fog that thins out with height, exp(zero - z / scale).
//
//   mist  r g b  hr hg hb  zero scale
//
// The mean density between two heights is the integral of the exponential over their difference.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/atmosphere/effect.h"
#include "rayshade/base/elementary.h"

namespace rayshade {

struct Mist {
  Color color, half;
  double zero = 0, scale = 1;

  static constexpr std::string_view keyword = "mist";
  static constexpr std::string_view examples[] = {".6 .6 .7  20 20 20  0 1"};

  static std::optional<Mist> parse(Arguments& in) {
    Mist mist;
    mist.color = in.color();
    mist.half = in.color();
    mist.zero = in.number();
    mist.scale = in.number();
    if (mist.scale == 0) in.fail("the scale of a mist is 0");
    return mist;
  }

  Color apply(Color seen, const AirPath& path) const {
    const double s = 1 / scale;
    const double z0 = path.start.z, z1 = path.end.z;
    const double rise = s * (z1 - z0);
    const double above = elementary::exp(zero - s * z1);
    const double density =
        std::abs(rise) > kNegligible ? (elementary::exp(zero - s * z0) - above) / rise : above;
    const double thickness = path.distance * density;
    return std::isnan(thickness) ? color : veil(seen, color, half, thickness);
  }
};

template <class Archive>
void serialize(Archive& archive, Mist& m) {
  archive(m.color, m.half, m.zero, m.scale);
}

}  // namespace rayshade
