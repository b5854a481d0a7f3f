// A turbulent layer of fog, seen from above: it thickens with the way below the plane z = altitude.
//
//   fogdeck  altitude  offset  sx sy sz  strength octaves  r g b  hr hg hb
//
// Where a ray crosses the plane, at q, the density is offset + strength c, with c the turbulence of the point
// (sx q.x, sy q.y, sz q.z); the half distances are divided by it and count from there on.
//
// differs from rayshade4: works as its manual says; a test there is cut to whole numbers and never passes.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/atmosphere/effect.h"
#include "rayshade/base/noise.h"

namespace rayshade {

struct FogDeck {
  double altitude = 0, offset = 0;
  Vec3 scale{1, 1, 1};
  double strength = 0;
  int octaves = 0;
  Color color, half;

  static constexpr std::string_view keyword = "fogdeck";
  static constexpr std::string_view examples[] = {"0.5  0  .6 .6 1  2.5 5  .9 .9 .95  2 2 2"};

  static std::optional<FogDeck> parse(Arguments& in) {
    FogDeck deck;
    deck.altitude = in.number();
    deck.offset = in.number();
    deck.scale = in.vector();
    deck.strength = in.number();
    deck.octaves = in.integer();
    deck.color = in.color();
    deck.half = in.color();
    return deck;
  }

  Color apply(Color seen, const AirPath& path) const {
    const Vec3 way = path.end - path.start;
    if (!(std::abs(way.z) >= kNegligible * path.distance)) return seen;  // along the deck
    const double share = (altitude - path.start.z) / way.z;
    if (!(share * path.distance >= kNegligible && share <= 1)) return seen;
    const Vec3 q = path.start + share * way;
    const double density =
        offset + strength * absoluteChaos({q.x * scale.x, q.y * scale.y, q.z * scale.z}, octaves);
    if (!(density >= kNegligible)) return seen;
    return veil(seen, color, half * (1 / density), (1 - share) * path.distance);
  }
};

template <class Archive>
void serialize(Archive& archive, FogDeck& d) {
  archive(d.altitude, d.offset, d.scale, d.strength, d.octaves, d.color, d.half);
}

}  // namespace rayshade
