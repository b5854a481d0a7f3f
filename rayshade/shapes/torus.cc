// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/torus.h"

#include <numbers>

#include "rayshade/base/elementary.h"
#include "rayshade/base/transform.h"

namespace rayshade {
namespace {

// The axes of rayshade's canonical torus, in object space; unit vectors at right angles.
Matrix axesOf(const Torus& torus) { return alongAxis({}, torus.axis, 1, 1).forward; }
Vec3 toCanonical(const Matrix& axes, Vec3 v) { return {dot(v, axes.x), dot(v, axes.y), dot(v, axes.z)}; }

// A line through canonical space in units of about the size of the torus, x = 0 at the point nearest to the
// centre.
struct Line {
  Vec3 foot, direction;
  double swept, tube;
};

Quartic quarticAlong(const Line& line) {
  const auto& [m, d, swept, tube] = line;
  const double rho = std::sqrt(m.x * m.x + m.y * m.y);
  const double inner = (rho - swept) * (rho - swept) + m.z * m.z - tube * tube;
  const double outer = (rho + swept) * (rho + swept) + m.z * m.z - tube * tube;
  const double md = dot(m, d);  // zero but for rounding
  const double k = dot(m, m) + swept * swept - tube * tube;
  const double four = 4 * swept * swept;
  return {inner * outer, 4 * md * k - 2 * four * (m.x * d.x + m.y * d.y),
          4 * md * md + 2 * k - four * (d.x * d.x + d.y * d.y), 4 * md, 1};
}

// How far the point at x is from the nearer sheet of the surface, and how that changes with x; squares, as in the file
// header.  `inside` changes at every sheet.
struct Residual {
  double value, slope;
  bool inside;
};
Residual residualAt(const Line& line, double x) {
  const Vec3 p = line.foot + x * line.direction, d = line.direction;
  const double rho = std::sqrt(p.x * p.x + p.y * p.y);
  const double rest = p.z * p.z - line.tube * line.tube;
  const double near = rho - line.swept, far = rho + line.swept;
  const double outer = near * near + rest, inner = far * far + rest;
  const bool isOuter = std::abs(outer) <= std::abs(inner);
  const double widening = rho > 0 ? (p.x * d.x + p.y * d.y) / rho : 0;
  return {isOuter ? outer : inner, 2 * ((isOuter ? near : far) * widening + p.z * d.z),
          (outer < 0) != (inner < 0)};
}

// The root in (a, b), of which one end is inside.
double closeIn(const Line& line, double a, double b, bool insideAtA) {
  double x = a + (b - a) / 2, step = b - a;
  // Every turn halves the bracket or Newton's step, so this ends long before the 128th.
  for (int turn = 0; turn < 128; ++turn) {
    const Residual at = residualAt(line, x);
    if (at.value == 0) return x;
    (at.inside == insideAtA ? a : b) = x;
    double next = x - at.value / at.slope;
    if (!(next > a && next < b && std::abs(next - x) <= std::abs(step) / 2)) next = a + (b - a) / 2;
    step = next - x;
    if (std::abs(step) <= 0x1p-53 * std::abs(x) || next == a || next == b) return next;
    x = next;
  }
  return x;
}

}  // namespace

std::optional<Torus> Torus::parse(Arguments& in) {
  Torus torus;
  torus.swept = in.number();
  torus.tube = in.number();
  torus.centre = in.vector();
  torus.axis = in.vector();
  // differs from rayshade4: no least size, only zero and less are degenerate
  const bool good = torus.swept > 0 && torus.tube > 0 && std::isfinite(torus.swept + torus.tube) &&
                    isFinite(torus.centre) && isFinite(torus.axis) && length(torus.axis) > 0;
  return good ? std::optional(torus) : std::nullopt;
}

Bounds Torus::bounds() const {
  const Vec3 a = normalize(axis);
  const Vec3 reach{swept * elementary::hypot(a.y, a.z) + tube, swept * elementary::hypot(a.x, a.z) + tube,
                   swept * elementary::hypot(a.x, a.y) + tube};
  return {centre - reach, centre + reach};
}

double Torus::intersect(const LocalRay& ray, double tMin) const {
  const double unit = std::ldexp(1.0, std::ilogb(swept + tube));
  const Vec3 start = ray.origin - centre;
  const double tFoot = -dot(start, ray.direction);
  const Vec3 foot = (start + tFoot * ray.direction) / unit;
  // Only the stretch inside of a sphere around the torus, a little too large so that no root lies at its end.
  const double reach = 1.0001 * (swept + tube) / unit;
  const double middle = -dot(foot, ray.direction);  // zero but for rounding, which is large from far away
  const Vec3 beside = foot + middle * ray.direction;
  const double quarter = reach * reach - dot(beside, beside);
  if (!(quarter >= 0)) return kNoHit;
  const double low = middle - std::sqrt(quarter), high = middle + std::sqrt(quarter);

  const Matrix axes = axesOf(*this);
  const Line line{toCanonical(axes, foot), toCanonical(axes, ray.direction), swept / unit, tube / unit};
  // Between two turning points of the quartic there is a root exactly when the ray changes sides; a turning point that is
  // on the surface is a root of its own (the ray touches).
  const Quartic c = quarticAlong(line);
  const Roots turns = rootsBetween(Cubic{c[1], 2 * c[2], 3 * c[3], 4 * c[4]}, low, high);
  const double touch = 8 * 0x1p-53 * line.tube * (line.swept + line.tube);
  double from = low;
  bool insideFrom = false, touched = false;
  for (std::size_t i = 0; i <= turns.count; ++i) {
    const bool last = i == turns.count;
    const double to = last ? high : turns.at[i];
    const Residual there = residualAt(line, to);
    const bool touches = !last && std::abs(there.value) <= touch;
    const bool crosses = !touches && !touched && there.inside != insideFrom;
    if (touches || crosses) {
      const double t = tFoot + unit * (touches ? to : closeIn(line, from, to, insideFrom));
      if (t > tMin) return t;
    }
    from = to;
    insideFrom = there.inside;
    touched = touches;
  }
  return kNoHit;
}

ShapePoint Torus::pointAt(const LocalRay& ray, double t) const {
  const Matrix axes = axesOf(*this);
  const Vec3 q = toCanonical(axes, ray.origin + t * ray.direction - centre);
  const double rho = elementary::hypot(q.x, q.y);
  const Vec3 outward = rho > 0 ? Vec3{q.x / rho, q.y / rho, 0} : Vec3{1, 0, 0};
  // The nearest point of the swept circle; on the inner sheet of a spindle torus the farthest one counts.
  const double near = elementary::hypot(rho - swept, q.z), far = elementary::hypot(rho + swept, q.z);
  const bool innerSheet = std::abs(far - tube) < std::abs(near - tube);
  const double middle = innerSheet ? -swept : swept, side = rho - middle, away = elementary::hypot(side, q.z);
  // In the plane of the axis, whatever rounding says: q may be on the swept circle itself.
  const Vec3 fromCircle = away > 0 ? (side / away) * outward + Vec3{0, 0, q.z / away} : outward;
  const Vec3 onSurface = middle * outward + tube * fromCircle;
  // Inside of the inner sheet the ray is outside of the solid, so the normal points there.
  const Vec3 normal = normalize(mapVector(axes, innerSheet ? -fromCircle : fromCircle));
  return {mapPoint(axes, onSurface) + centre,
          normal,
          normal,
          {},
          2 * kRounding * (maxAbs(centre) + swept + tube),
          1 / std::min(tube, std::abs(swept - tube))};
}

// u around the axis, v around the tube, 0 where the tube is nearest to the axis.
// differs from rayshade4: dpdv is not taken through the transform of the torus twice.
SurfaceCoordinates Torus::coordinates(const ShapePoint& at, Vec3 position) const {
  constexpr double kTurn = 2 * std::numbers::pi;
  const Matrix axes = axesOf(*this);
  const Vec3 q = toCanonical(axes, position - centre);
  const double around = elementary::atan2(q.y, q.x) / kTurn;
  const double v =
      elementary::acos(std::clamp((swept - elementary::hypot(q.x, q.y)) / tube, -1.0, 1.0)) / kTurn;
  SurfaceCoordinates c;
  c.u = around < 0 ? around + 1 : around;
  c.v = q.z > 0 ? 1 - v : v;
  c.dpdu = normalize(mapVector(axes, {-q.y, q.x, 0}));
  if (c.dpdu == Vec3{}) c.dpdu = axes.y;
  c.dpdv = normalize(cross(at.geometricNormal, c.dpdu));
  return c;
}

}  // namespace rayshade
