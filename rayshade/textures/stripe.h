// Tiles with bevelled edges and stripes of another surface between them.
//
//   stripe SURFACE width bump [map MAPPING]
//
// In every unit square of (u, v), what is below `width` in u or v has the surface; around the rest runs an
// edge as wide again, whose normal is bent by `bump`.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/textures/mapping.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Stripe {
  Surface between;
  double width = 0, bump = 0;
  Mapping mapping;

  static constexpr std::string_view keyword = "stripe";
  static constexpr TextureNeeds needs = TextureNeeds::coordinates;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {
      "diffuse 0.7 0.3 0.3 0.1 0.7", "diffuse 0.7 0.3 0.3 0.15 0 map planar 0 0 0  0 0 1  1 0.5 0"};

  static std::optional<Stripe> parse(Arguments& in) {
    Stripe stripe;
    stripe.between = in.surface();
    stripe.width = in.number();
    stripe.bump = in.number();
    if (in.accept("map")) stripe.mapping = parseMapping(in);
    return stripe;
  }

  const Surface* otherSurface() const { return &between; }
  void apply(TextureHit& hit) const {
    const double u = hit.u - std::floor(hit.u), v = hit.v - std::floor(hit.v);
    if (u < width || v < width) {
      hit.surface = between;
      return;
    }
    auto inside = [this](double x) { return x > 2 * width && x <= 1 - width; };
    if (inside(u) && inside(v)) return;
    // On an edge; the diagonals of the tile say on which.
    const double across = (u - width) / (1 - width), up = (v - width) / (1 - width);
    const bool belowRising = up < across, belowFalling = up < 1 - across;
    if (belowRising == belowFalling)
      hit.normal = bendAlongTangents(hit, 0, belowRising ? -bump : bump);  // bottom, top
    else
      hit.normal = bendAlongTangents(hit, belowRising ? bump : -bump, 0);  // right, left
  }
};

template <class Archive>
void serialize(Archive& archive, Stripe& s) {
  archive(s.between, s.width, s.bump, s.mapping);
}

}  // namespace rayshade
