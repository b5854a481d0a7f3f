// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/csg.h"

#include "rayshade/intersect/ray_hit.h"

namespace rayshade {
namespace {

struct Crossing {
  double t = kNoHit;
  bool entering = false;
  bool exists() const { return t < kNoHit; }
  bool insideBefore() const { return exists() && !entering; }
};

// Does a ray enter the object at its crossing at t?
bool enteringAt(const Model& model, ObjectIndex index, const LocalRay& outer, const Moment& moment,
                double t) {
  const SceneStore& store = model.store();
  const PlacedObject& object = store.object(index);
  const LocalRay ray = intoNode(store, object.node, outer, moment);
  const double before = std::nextafter(t, -kInfinity);
  if (object.kind == kCsgKind) return csgCrossing(model, store.csg(object), ray, moment, before).entering;
  if (object.kind == kInstanceKind) {
    const Hit inside = nearestHit(model, model.definition(store.instance(object)), ray, moment, before,
                                  std::nextafter(t, kInfinity));
    return inside.found() && enteringAt(model, inside.object, ray, moment, t);
  }
  const double root = rootAt(model, {index, ray}, t);
  const Vec3 normal =
      withShape(store, object, [&](const auto& shape) { return shape.pointAt(ray, root).geometricNormal; });
  return dot(ray.direction, normal) < 0;
}

Crossing nextCrossing(const Model& model, ObjectIndex index, const LocalRay& ray, const Moment& moment,
                      double tMin) {
  const double t = RayIntersector(model, ray, moment).intersect(model.target(index), tMin);
  if (!(t < kNoHit)) return {};
  return {t, enteringAt(model, index, ray, moment, t)};
}

bool inResult(CsgOperation operation, bool inFirst, bool inSecond) {
  switch (operation) {
    case CsgOperation::unite:
      return inFirst || inSecond;
    case CsgOperation::intersect:
      return inFirst && inSecond;
    case CsgOperation::subtract:
      return inFirst && !inSecond;
  }
  return false;
}

}  // namespace

CsgCrossing csgCrossing(const Model& model, const Csg& csg, const LocalRay& ray, const Moment& moment,
                        double tMin) {
  const auto [first, second] = model.operandsOf(csg);
  if (first == kNone || second == kNone) return {};
  Crossing a = nextCrossing(model, first, ray, moment, tMin);
  Crossing b = nextCrossing(model, second, ray, moment, tMin);
  const double reach = maxAbs(ray.origin) / ray.scale;
  while (a.exists() || b.exists()) {
    const double t = std::min(a.t, b.t);
    const double together = 16 * kRounding * (std::abs(t) + reach);
    const bool crossesA = a.t <= t + together, crossesB = b.t <= t + together;
    const bool before = inResult(csg.operation, a.insideBefore(), b.insideBefore());
    const bool after = inResult(csg.operation, crossesA ? a.entering : a.insideBefore(),
                                crossesB ? b.entering : b.insideBefore());
    if (before != after) return crossesA ? CsgCrossing{a.t, first, after} : CsgCrossing{b.t, second, after};
    if (crossesA) a = nextCrossing(model, first, ray, moment, a.t);
    if (crossesB) b = nextCrossing(model, second, ray, moment, b.t);
  }
  return {};
}

}  // namespace rayshade
