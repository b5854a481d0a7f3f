// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/textures/mapping.h"

#include <numbers>

#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

// The angle around the axis, as a share of a turn.
double turnOf(double across, double aside) {
  const double turn = elementary::atan2(aside, across) / (2 * std::numbers::pi);
  return turn < 0 ? turn + 1 : turn;
}

MappedCoordinates spherical(const Mapping& mapping, Vec3 position) {
  constexpr double kPole = 1e-5;  // u is 0 this close to a pole, in v
  const Vec3 q = normalize(position - mapping.origin);
  const double x = dot(q, mapping.across), y = dot(q, mapping.aside), z = dot(q, mapping.up);
  MappedCoordinates at;
  at.v = elementary::acos(std::clamp(-z, -1.0, 1.0)) / std::numbers::pi;
  if (at.v >= kPole && at.v <= 1 - kPole) at.u = turnOf(x, y);
  // differs from rayshade4: it leaves the tangents unset.
  at.dpdu = normalize(x * mapping.aside - y * mapping.across);
  if (at.dpdu == Vec3{}) at.dpdu = mapping.aside;
  at.dpdv = cross(q, at.dpdu);
  return at;
}

MappedCoordinates cylindrical(const Mapping& mapping, Vec3 position) {
  const Vec3 q = position - mapping.origin;
  return {turnOf(dot(q, mapping.across), dot(q, mapping.aside)), dot(q, mapping.up),
          normalize(cross(mapping.up, position)), mapping.up};
}

// Sets the rows that give p = u along + v up + w (along x up) its u and v; false when there are none.
bool setPlanarAxes(Mapping& mapping, Vec3 up, Vec3 along) {
  const Vec3 upright = cross(along, up);
  const double area = dot(upright, upright);
  mapping.up = up;
  mapping.along = along;
  mapping.across = cross(up, upright) / area;
  mapping.aside = cross(upright, along) / area;
  return area > 0 && isFinite(mapping.across) && isFinite(mapping.aside);
}

bool setRoundAxes(Mapping& mapping, Vec3 up, Vec3 across) {
  mapping.up = normalize(up);
  mapping.aside = normalize(cross(mapping.up, normalize(across)));
  mapping.across = normalize(cross(mapping.aside, mapping.up));
  return mapping.aside != Vec3{};
}

}  // namespace

Mapping parseMapping(Arguments& in) {
  Mapping mapping;
  if (in.accept("uv")) return mapping;
  if (in.accept("spherical")) {
    mapping.kind = Mapping::Kind::spherical;
  } else if (in.accept("cylindrical")) {
    mapping.kind = Mapping::Kind::cylindrical;
  } else if (in.accept("planar")) {
    mapping.kind = Mapping::Kind::planar;
    mapping.up = {0, 1, 0};
  } else {
    in.fail("a mapping is uv, spherical, cylindrical or planar");
  }
  if (!in.numberFollows()) return mapping;
  mapping.origin = in.vector();
  const Vec3 up = in.vector();
  const Vec3 across = in.vector();
  const bool planar = mapping.kind == Mapping::Kind::planar;
  if (!(planar ? setPlanarAxes(mapping, up, across) : setRoundAxes(mapping, up, across)))
    in.fail("the axes of a mapping are parallel or have no length");
  return mapping;
}

MappedCoordinates coordinatesOf(const Mapping& mapping, Vec3 position) {
  switch (mapping.kind) {
    case Mapping::Kind::spherical:
      return spherical(mapping, position);
    case Mapping::Kind::cylindrical:
      return cylindrical(mapping, position);
    case Mapping::Kind::planar:
      return {dot(position, mapping.across), dot(position, mapping.aside), mapping.along, mapping.up};
    case Mapping::Kind::uv:
      break;
  }
  return {};
}

Vec3 toPrimitive(const TexturePlace& place, Vec3 point) {
  return mapPoint(place.texture.forward,
                  mapPoint(place.object.inverse, mapPoint(place.texture.inverse, point)));
}

Vec3 toPrimitiveVector(const TexturePlace& place, Vec3 vector) {
  return mapVector(place.texture.forward,
                   mapVector(place.object.inverse, mapVector(place.texture.inverse, vector)));
}

MappedCoordinates throughTransforms(const TexturePlace& place, const MappedCoordinates& coordinates) {
  const Vec3 uv = mapPoint(place.texture.inverse, {coordinates.u, coordinates.v, 0});
  const Vec3 rows[] = {mapVector(place.object.forward, coordinates.dpdu),
                       mapVector(place.object.forward, coordinates.dpdv),
                       mapVector(place.object.forward, place.geometricNormal)};
  auto combined = [&rows](Vec3 share) {
    return normalize(share.x * rows[0] + share.y * rows[1] + share.z * rows[2]);
  };
  return {uv.x, uv.y, combined(place.texture.forward.x), combined(place.texture.forward.y)};
}

}  // namespace rayshade
