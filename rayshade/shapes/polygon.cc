// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/polygon.h"

#include <cstdio>

#include "rayshade/shapes/plane.h"
#include "rayshade/shapes/shear.h"

namespace rayshade {
namespace {

// Newell's normal with the first corner as origin, so that a polygon far away loses nothing, and divided by
// `size`, the extent of the polygon, on the way; its length is twice the area in these units.
Vec3 newell(const std::vector<Vec3>& corners, double size) {
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum = sum + cross((corners[i] - corners[0]) / size, (corners[i + 1] - corners[0]) / size);
  return sum;
}

// The same of a large triangle of its corners, in their order, for a polygon whose parts cancel in the sum.
Vec3 normalOfLargeTriangle(const std::vector<Vec3>& corners, double size) {
  const auto from = [&](std::size_t i) { return (corners[i] - corners[0]) / size; };
  std::size_t far = 0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (dot(from(i), from(i)) > dot(from(far), from(far))) far = i;
  constexpr double kClearly = 1.001;  // of equals the first one, whatever rounding says
  Vec3 largest;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Vec3 normal = i < far ? cross(from(i), from(far)) : cross(from(far), from(i));
    if (length(normal) > kClearly * length(largest)) largest = normal;
  }
  return largest;
}

// Does the outline wind around the ray, or pass through it?
// differs from rayshade4: the corners are projected along the ray, not along an axis, so that also polygons that
// are not quite plane have no holes along the edges they share.
template <class Shear>
bool windsAround(const std::vector<Vec3>& corners, const Shear& shear) {
  int winding = 0;
  ShearedPoint a = shear(corners.back());
  for (const Vec3& corner : corners) {
    const ShearedPoint b = shear(corner);
    if ((a.y <= 0) != (b.y <= 0)) {
      const double side = turn(a, b);
      if (side == 0) return true;
      if ((b.y > 0) == (side > 0)) winding += b.y > 0 ? 1 : -1;  // crosses the half-line x > 0
    } else if (b.y == 0 && (b.x == 0 || (a.y == 0 && (a.x < 0) != (b.x < 0)))) {
      return true;  // the ray meets a corner or a level edge
    }
    a = b;
  }
  return winding != 0;
}

// The projection along an axis, with a point as origin.
auto dropAxis(Vec3 origin, int axis) {
  return [=](Vec3 corner) {
    const Vec3 p = corner - origin;
    return ShearedPoint{p[(axis + 1) % 3], p[(axis + 2) % 3]};
  };
}

// t, moved to where the ray is inside of the extent.
double insideExtent(const Bounds& extent, const LocalRay& ray, double t) {
  double entry = -kInfinity, exit = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double direction = ray.direction[axis];
    if (direction == 0) continue;
    // Well between the two sides: t is between theirs, and four divisions are spared.
    const double step = t * direction, at = ray.origin[axis] + step;
    const double error = kRounding * (std::abs(ray.origin[axis]) + std::abs(step));
    if (at - error > extent.low[axis] && at + error < extent.high[axis]) continue;
    const double toLow = (extent.low[axis] - ray.origin[axis]) / direction;
    const double toHigh = (extent.high[axis] - ray.origin[axis]) / direction;
    entry = std::max(entry, std::min(toLow, toHigh));
    exit = std::min(exit, std::max(toLow, toHigh));
  }
  return std::min(std::max(t, entry), exit);
}

std::string shortText(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", x);
  return text;
}

}  // namespace

std::optional<Polygon> Polygon::parse(Arguments& in) {
  Polygon polygon;
  polygon.corners.clear();
  while (in.numberFollows()) polygon.corners.push_back(in.vector());
  if (polygon.corners.size() < 3) in.fail("a polygon has three corners or more");
  for (const Vec3& corner : polygon.corners)
    if (!(maxAbs(corner) < 0x1p+500)) return std::nullopt;
  Bounds corners;
  for (const Vec3& corner : polygon.corners) corners = join(corners, corner);
  const double size = maxAbs(corners.size());
  if (!(size > 0x1p-480)) return std::nullopt;
  Vec3 sum = newell(polygon.corners, size);
  // differs from rayshade4: a polygon may be as small as you like; only one whose area is rounding is not one.  Two
  // equal lobes that run against each other have an area, too.
  const double rounding = kRounding * static_cast<double>(polygon.corners.size());
  if (!(length(sum) > rounding)) sum = normalOfLargeTriangle(polygon.corners, size);
  if (!(length(sum) > rounding)) return std::nullopt;
  polygon.normal = normalize(sum);
  double off = 0;  // the farthest corner from the plane
  for (const Vec3& corner : polygon.corners)
    off = std::max(off, std::abs(dot(corner - polygon.corners[0], polygon.normal)));
  constexpr double kToSay = 1e-10, kBend = 1e-4;  // more than decimals in a file explain
  polygon.bent = off > kBend * size;
  if (off > kToSay * size)
    in.warn("the corners of this polygon are not in one plane, but up to " + shortText(off) + " out of it");
  polygon.prepare();
  return polygon;
}

double Polygon::intersect(const LocalRay& ray, double tMin, double tMax) const {
  const double t = meetPlane(ray, corners[0], normal);
  // The plane decides whether it is before the ray: only what is there may be moved, or a surface would meet rays that leave it.
  if (!(t > 0 && t < kNoHit)) return kNoHit;
  const double clipped = insideExtent(extent, ray, t);
  if (!(clipped > tMin && clipped <= tMax)) return kNoHit;
  return (bent ? windsAround(corners, dropAxis(ray.origin + t * ray.direction, dominantAxis(normal)))
               : inside(ray, t))
             ? clipped
             : kNoHit;
}

bool Polygon::inside(const LocalRay& ray, double t) const {
  if (outline)
    if (const std::optional<bool> sure = outline->windsAround(corners, ray, t)) return *sure;
  return lookAlong(ray, [this](const auto& shear) { return windsAround(corners, shear); });
}

void Polygon::prepare() {
  extent = {};
  const int axis = dominantAxis(normal);
  for (Vec3 corner : corners) {
    extent = join(extent, corner);
    corner[axis] -= dot(corner - corners[0], normal) / normal[axis];  // its place in the plane
    extent = join(extent, corner);
  }
  constexpr std::size_t kMany = 9;  // with fewer corners the exact test is as fast
  if (corners.size() >= kMany && !bent) outline = std::make_shared<const Outline>(corners, normal);
}

ShapePoint Polygon::pointAt(const LocalRay& ray, double t) const {
  return ontoPlane(ray.origin + t * ray.direction, corners[0], normal);
}

Polygon Polygon::flipped() const {
  Polygon other{{corners.rbegin(), corners.rend()}, -normal, bent};
  other.prepare();
  return other;
}

}  // namespace rayshade
