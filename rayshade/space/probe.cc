// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/space/probe.h"

#include "rayshade/space/csg.h"

namespace rayshade {
namespace {

template <class S>
double intersectShape(const S& shape, const LocalRay& ray, double tMin) {
  if (ray.scale == 1) return shape.intersect(ray, tMin);
  // What counts is t > tMin in world units: two roots may round to one there, and one root to two.
  const double from = tMin * ray.scale;
  double local = shape.intersect(ray, from - std::abs(from) * 0x1p-50);
  while (local < kNoHit && local / ray.scale <= tMin) local = shape.intersect(ray, local);
  return local / ray.scale;
}

// Does the type at a position of AllShapes have one of these keywords?
constexpr bool keywordIs(BodyKind kind, std::initializer_list<std::string_view> words) {
  bool found = false;
  std::size_t position = 0;
  AllShapes::forEach([&]<class S>() {
    if (position++ != static_cast<std::size_t>(kind)) return;
    for (std::string_view word : words) found = found || S::keyword == word;
  });
  return found;
}

}  // namespace

bool isFlat(BodyKind kind) { return keywordIs(kind, {"disc", "polygon", "triangle", "triangleuv"}); }
bool isUnbounded(BodyKind kind) { return keywordIs(kind, {"plane"}); }

Opacity opacityOf(const Model& model, ObjectIndex index) {
  const SceneStore& store = model.store();
  if (!store.anyTransparent()) return Opacity::opaque;
  const PlacedObject& object = store.object(index);
  // An instance or CSG is looked into only when it is hit; until then it may be transparent.
  if (object.kind == kInstanceKind || object.kind == kCsgKind) return Opacity::transparent;
  return store.surfaceOrDefault(object.surface).transparency >= kNegligible ? Opacity::transparent
                                                                            : Opacity::opaque;
}

double Probe::intersect(ObjectIndex index, double tMin, double tMax) {
  const PlacedObject& object = model.store().object(index);
  const LocalRay& local = rayIn(object.frame);
  if (object.kind == kInstanceKind) {
    return nearestHit(model, model.definition(model.store().instance(object)), local, moment, tMin,
                      tMax < kNoHit ? std::nextafter(tMax, kInfinity) : kNoHit)
        .t;
  }
  if (object.kind == kCsgKind) return csgCrossing(model, model.store().csg(object), local, moment, tMin).t;
  double t = kNoHit;
  [&]<class... S>(TypeList<S...>) {
    const std::size_t kind = static_cast<std::size_t>(object.kind);
    std::size_t i = 0;
    (void)((kind == i++ ? (t = intersectShape(model.store().shapes<S>()[object.body], local, tMin), true)
                        : false) ||
           ...);
  }(AllShapes{});
  return t;
}

Hit nearestHit(const Model& model, const Region& region, const LocalRay& ray, const Moment& moment,
               double tMin, double tExit) {
  Probe probe{model, ray, moment};
  Hit best;
  double limit = tExit * ray.scale;  // in the units of the region, for the accelerator
  region.bvh.nearest(
      ray.origin, ray.direction, tMin * ray.scale, limit, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = first; i < first + count; ++i) {
          const ObjectIndex index = region.objects[i];
          const double t = probe.intersect(index, tMin, std::min(best.t, tExit));
          if (!(t < tExit) || t > best.t) continue;
          if (t == best.t &&
              precedence(model.store().object(index)) >= precedence(model.store().object(best.object)))
            continue;
          best = {t, index};
          limit = t * ray.scale;
        }
      });
  return best;
}

}  // namespace rayshade
