// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/frustum.h"

#include <numbers>

#include "rayshade/base/elementary.h"
#include "rayshade/base/transform.h"

namespace rayshade {
namespace {

// a x - b y, where the products cancel.
// Source: Kahan; error at most 1.5 ulp: Jeannerod, Louvet & Muller 2013, Further analysis of Kahan's algorithm.
double difference(double a, double x, double b, double y) {
  const double right = b * y;
  return std::fma(a, x, -right) + std::fma(-b, y, right);
}
Vec3 difference(double a, Vec3 x, double b, Vec3 y) {
  return {difference(a, x.x, b, y.x), difference(a, x.y, b, y.y), difference(a, x.z, b, y.z)};
}
Vec3 sharpCross(Vec3 a, Vec3 b) {
  return {difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x)};
}

}  // namespace

std::optional<Frustum> frustumBetween(Vec3 base, double baseRadius, Vec3 top, double topRadius) {
  if (topRadius < baseRadius) {
    std::swap(base, top);
    std::swap(baseRadius, topRadius);
  }
  // differs from rayshade4: length and radii may be as small as you like, but not zero.
  const Vec3 between = top - base;
  const double height = length(between);
  constexpr double kMost = 0x1p+500;  // squares stay in the range of numbers
  const bool finite = maxAbs(base) < kMost && height < kMost && std::isfinite(topRadius);
  if (!(height > 0) || !(baseRadius >= 0) || !(topRadius > 0) || !finite) return std::nullopt;
  return Frustum{base, normalize(between), height, baseRadius, topRadius};
}

Bounds Frustum::bounds() const {
  const Vec3 reach{elementary::hypot(axis.y, axis.z), elementary::hypot(axis.z, axis.x),
                   elementary::hypot(axis.x, axis.y)};
  const Vec3 end = base + length * axis;
  return join(Bounds{base - radius * reach, base + radius * reach},
              Bounds{end - endRadius * reach, end + endRadius * reach});
}

// A ray nearly along a generator has a small A, of which little is left but rounding; its far root may be near the
// apex, where that shows.  Newton's steps from the point itself, as long as they shrink.  Where they stop the point is on
// the side but for its rounding, or the root was no more than the rounding of A and the discriminant.
double Frustum::improved(double root, Vec3 from, Vec3 direction, double between) const {
  const double climb = dot(direction, axis);
  const Vec3 e = direction - climb * axis;
  double largest = between;
  for (int turn = 0; turn < 4; ++turn) {
    const Vec3 p = from + root * direction;
    const double height = dot(p, axis);
    const Vec3 f = p - height * axis;
    const double there = radius + growth() * height, rho = rayshade::length(f);
    const double off = rho - there;
    const double step = off * (rho + there) / (2 * (dot(f, e) - there * growth() * climb));
    if (!(std::abs(step) < 0.5 * largest)) {
      const double blur = kRounding * (std::abs(root) + length + endRadius);
      return off * off > blur * blur * (1 + growth() * growth()) ? kNoHit : root;
    }
    largest = std::abs(step);
    root -= step;
    if (largest <= 0x1p-52 * std::abs(root)) break;
  }
  return root;
}

double Frustum::intersect(const LocalRay& ray, double tMin) const { return nearest<false>(ray, tMin); }

template <bool alongGenerator>
double Frustum::nearest(const LocalRay& ray, double tMin) const {
  const Vec3 from = ray.origin - base;
  // The distance of the two lines, against the largest radius: most rays that miss are known by it.
  const Vec3 across = cross(ray.direction, axis);
  const double apart = dot(from, across), reach = endRadius * endRadius;
  if (apart * apart > reach * dot(across, across) + kRounding * 16 * (dot(from, from) + reach)) return kNoHit;
  const double height = dot(from, axis), climb = dot(ray.direction, axis);
  const Vec3 f = from - height * axis, e = ray.direction - climb * axis;
  const double there = radius + growth() * height, widening = growth() * climb;  // F and E of the header

  const double square = dot(e, e), a = square - widening * widening;
  // Rounding of slip and turn moves the surface |e| / sqrt(A) times as far as rounding of the origin does.
  if (!alongGenerator && std::abs(a) < 0x1p-8 * square) [[unlikely]]
    return nearest<true>(ray, tMin);
  const double b = dot(f, e) - there * widening;
  const double c = dot(f, f) - there * there;
  const Vec3 slip = alongGenerator ? difference(there, e, widening, f) : there * e - widening * f;
  const Vec3 turn = alongGenerator ? sharpCross(f, e) : cross(f, e);
  double discriminant = dot(slip, slip) - dot(turn, turn);
  // A ray steeper than the side always meets the double cone twice, if only at the apex: less is rounding.
  if (a < 0) discriminant = std::max(discriminant, 0.0);
  if (!(discriminant >= 0)) return kNoHit;

  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double far = q / a, reachable = std::abs(far);
  // Not beyond the far one: near a tangent c is rounding.
  const double other = std::min(std::max(c / q, -reachable), reachable);
  double first = kNoHit;
  // A ray along a generator has a = 0 and one root, a ray along a cylinder none, a ray through the apex may
  // have q = 0: what is infinite or NaN then fails the comparisons.
  for (double root : {far, other}) {
    if (endRadius != radius) root = improved(root, from, ray.direction, std::abs(far - other));
    const double z = height + root * climb;
    if (root > tMin && root < first && z >= 0 && z <= length) first = root;
  }
  return first;
}

ShapePoint Frustum::pointAt(const LocalRay& ray, double t) const {
  const Vec3 from = ray.origin + t * ray.direction - base;
  const double height = dot(from, axis);
  Vec3 radial = from - height * axis;
  radial = radial - dot(radial, axis) * axis;
  const double distance = rayshade::length(radial);
  // Onto the nearest point of the generator: straight out would move far when the cone is nearly a disc.
  const double widening = endRadius - radius;
  const double share =
      (height * length + (distance - radius) * widening) / (length * length + widening * widening);
  const double along = std::min(std::max(share, 0.0), 1.0);
  Vec3 outward = normalize(radial);
  Vec3 normal = normalize(length * outward - widening * axis);
  if (outward == Vec3{}) {  // on the axis: the apex, which looks along it
    outward = basisAround(axis).first;
    normal = widening > 0 ? -axis : outward;
  }
  const Vec3 position = base + (along * length) * axis + (radius + along * widening) * outward;
  return {position,
          normal,
          normal,
          {},
          kRounding * (maxAbs(base) + length + endRadius),
          radius == endRadius ? 1 / radius : kInfinity};
}

SurfaceCoordinates Frustum::coordinates(Vec3 position) const {
  const Affine place = alongAxis(base, axis, 1, length);
  const Vec3 canonical = mapPoint(place.inverse, position);
  const double distance = elementary::hypot(canonical.x, canonical.y);
  SurfaceCoordinates at;
  at.v = canonical.z;
  if (distance > 0) {
    const double turn =
        elementary::acos(std::clamp(canonical.x / distance, -1.0, 1.0)) / (2 * std::numbers::pi);
    at.u = canonical.y < 0 ? 1 - turn : turn;
  }
  const Vec3 radial = distance > 0 ? Vec3{canonical.x / distance, canonical.y / distance, 0} : Vec3{1, 0, 0};
  at.dpdu = normalize(mapVector(place.forward, {-radial.y, radial.x, 0}));
  // differs from rayshade4: the cone's tangents are turned into place once, not twice.
  at.dpdv = normalize(axis + growth() * normalize(mapVector(place.forward, radial)));
  return at;
}

}  // namespace rayshade
