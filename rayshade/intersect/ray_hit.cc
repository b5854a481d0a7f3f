// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/ray_hit.h"

#include "rayshade/intersect/csg.h"
#include "rayshade/intersect/nearer.h"

namespace rayshade {
namespace {

template <class S>
double intersectShape(const S& shape, const LocalRay& ray, double tMin, double tMax) {
  if (ray.scale == 1) return firstWithin(shape, ray, tMin, tMax);
  // What counts is t > tMin in world units: two roots may round to one there, and one root to two.
  const double from = tMin * ray.scale;
  double local = shape.intersect(ray, from - std::abs(from) * 0x1p-50);
  while (local < kNoHit && local / ray.scale <= tMin) local = shape.intersect(ray, local);
  return local / ray.scale;
}

}  // namespace

const LocalRay& RayIntersector::rayIn(NodeIndex node) {
  if (node != lastNode_) {
    lastRay_ = intoNode(model_.store(), node, ray_, moment_);
    lastNode_ = node;
  }
  return lastRay_;
}

double RayIntersector::intersectAny(const Target& target, double tMin, double tMax) {
  const LocalRay& local = target.node == 0 ? ray_ : rayIn(target.node);
  if (!(local.scale > 0)) return kNoHit;
  const SceneStore& store = model_.store();
  if (target.kind == kInstanceKind) {
    return nearestHit(model_, model_.definition(store.instance(target.body)), local, moment_, tMin,
                      tMax < kNoHit ? std::nextafter(tMax, kInfinity) : kNoHit)
        .t;
  }
  if (target.kind == kCsgKind)
    return firstCrossing(model_, model_.solid(target.body), local, moment_, tMin).t;
  double t = kNoHit;
  [&]<class... S>(TypeList<S...>) {
    (void)((target.kind == kKindOf<S>
                ? (t = intersectShape(store.shapes<S>()[target.body], local, tMin, tMax), true)
                : false) ||
           ...);
  }(AllShapes{});
  return t;
}

Hit nearestHit(const Model& model, const Region& region, const LocalRay& ray, const Moment& moment,
               double tMin, double tExit) {
  RayIntersector intersector(model, ray, moment);
  const SceneStore& store = model.store();
  Hit best;
  double limit = tExit * ray.scale;  // in the units of the region, for the accelerator
  region.bvh.nearest(ray.origin, ray.direction, tMin * ray.scale, limit,
                     [&](std::uint32_t first, std::uint32_t count) {
                       best.tests += count;
                       for (const Target& target : std::span(region.objects).subspan(first, count)) {
                         const double end = std::min(best.t, tExit);
                         const double t = intersector.intersect(target, tMin, end);
                         if (!nearer(t, store.object(target.object), end,
                                     best.found() ? &store.object(best.object) : nullptr))
                           continue;
                         best.t = t;
                         best.object = target.object;
                         limit = t * ray.scale;
                       }
                     });
  return best;
}

Hit hitAt(const Model& model, const Region& region, const LocalRay& ray, const Moment& moment, double t) {
  return nearestHit(model, region, ray, moment, std::nextafter(t, -kInfinity), std::nextafter(t, kInfinity));
}

}  // namespace rayshade
