// From a hit to the u and v of a picture.
//
//   map uv                                 the primitive's own coordinates (the default)
//   map spherical    [origin up across]    u around the axis `up` from `across`, v from pole to pole
//   map cylindrical  [origin up across]    u the same, v along the axis
//   map planar       [origin v u]          p = u across + v up + anything upright on both
//
// Without vectors the axis is z, or y of a planar mapping, and `across` is x.  As in rayshade, the origin of a
// planar mapping counts for nothing, the tangents of a cylindrical one ignore it too, and the planar axes set
// the scale by their lengths.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/transform.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

struct Mapping {
  enum class Kind : std::uint8_t { uv, spherical, cylindrical, planar } kind = Kind::uv;
  Vec3 origin;
  // Spherical and cylindrical: the axes around the origin, unit and at right angles.  Planar: u = p.across
  // and v = p.aside, and `along` and `up` are the directions in which they grow.
  Vec3 across{1, 0, 0}, aside{0, 1, 0}, up{0, 0, 1}, along{1, 0, 0};
};

// A hit between the shape and a textured frame.
struct TexturePlace {
  Vec3 position;         // parent space of the frame
  Vec3 rayOrigin;        // parent space
  Vec3 rayDirection;     // parent space, any length
  Vec3 geometricNormal;  // the primitive's space, unit, towards the viewer
  Affine object;         // P: from the primitive's space to the parent space
  Affine texture;        // T: the transforms behind the texture, in the order written
};

// What a mapping or a shape says of a point.
struct MappedCoordinates {
  double u = 0, v = 0;
  Vec3 dpdu, dpdv;
};

// `map` and what follows it, behind the word `map`.
Mapping parseMapping(Arguments& in);

// The coordinates of a point of the parent space for the kinds other than uv.
MappedCoordinates coordinatesOf(const Mapping& mapping, Vec3 position);

// Where a point of the parent space is looked up on the primitive.  The exact way would be P^-1 alone; this is
// rayshade's, which is the same when P or T is the identity or they commute: p T^-1 P^-1 T.
Vec3 toPrimitive(const TexturePlace& place, Vec3 point);
Vec3 toPrimitiveVector(const TexturePlace& place, Vec3 vector);

// u and v as points of the texture's plane, tangents in the parent space, as rayshade carries them over: with
// rows (dpdu, dpdv, geometric normal), times P, and T times that.
MappedCoordinates throughTransforms(const TexturePlace& place, const MappedCoordinates& coordinates);

// The coordinates that a texture with this mapping is given.  `ofPrimitive(point)` returns u, v, dpdu and dpdv
// of a point in the primitive's space.
template <class OfPrimitive>
MappedCoordinates mapCoordinates(const Mapping& mapping, const TexturePlace& place, OfPrimitive ofPrimitive) {
  if (mapping.kind != Mapping::Kind::uv)
    return throughTransforms(place, coordinatesOf(mapping, place.position));
  const auto at = ofPrimitive(toPrimitive(place, place.position));
  return throughTransforms(place, {at.u, at.v, at.dpdu, at.dpdv});
}

template <class Archive>
void serialize(Archive& archive, Mapping& m) {
  archive(m.kind, m.origin, m.across, m.aside, m.up, m.along);
  if constexpr (Archive::kReading) {
    if (m.kind > Mapping::Kind::planar) {
      m = {};
      archive.fail();
    }
  }
}

}  // namespace rayshade
