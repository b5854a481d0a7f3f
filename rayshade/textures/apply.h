// Applies a texture of any kind to a hit.
//
// For every textured frame on the way up from the primitive, and every texture of it in the order of the file:
// applyTexture(), with `hit.normal` in that frame's parent space.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/textures/all.h"
#include "rayshade/textures/mapping.h"

namespace rayshade {

// `ofPrimitive(point)` returns something with u, v, dpdu and dpdv for a point in the primitive's space that
// need not lie on the surface; it is asked only for the mapping uv.
template <class OfPrimitive>
void applyTexture(const AnyTexture& any, TextureHit& hit, const TexturePlace& place,
                  OfPrimitive ofPrimitive) {
  hit.position = mapPoint(place.texture.inverse, place.position);
  std::visit(
      [&](const auto& texture) {
        constexpr TextureNeeds kNeeds = std::decay_t<decltype(texture)>::needs;
        if constexpr (kNeeds == TextureNeeds::coordinates) {
          const MappedCoordinates at = mapCoordinates(texture.mapping, place, ofPrimitive);
          hit.u = at.u;
          hit.v = at.v;
          hit.dpdu = at.dpdu;
          hit.dpdv = at.dpdv;
        } else if constexpr (kNeeds == TextureNeeds::ray) {
          hit.rayOrigin = toPrimitive(place, place.rayOrigin);
          hit.rayDirection = normalize(toPrimitiveVector(place, place.rayDirection));
        }
        texture.apply(hit);
      },
      any);
  limit(hit.surface);
  ++hit.turn;
}

}  // namespace rayshade
