// One ray against the objects of one container: the inner loop.
//
// t is in world units everywhere; each object's local ray carries the scale between the two.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/intersect/model.h"

namespace rayshade {

// Calls f with the shape of an object that is neither instance nor CSG.
template <class F>
auto withShape(const SceneStore& store, const PlacedObject& object, F&& f) {
  return [&]<class... S>(TypeList<S...>) {
    using Result = std::common_type_t<decltype(f(std::declval<const S&>()))...>;
    using Call = Result (*)(const SceneStore&, std::uint32_t, F&);
    static constexpr Call calls[] = {[](const SceneStore& from, std::uint32_t body, F& use) -> Result {
      return use(from.shapes<S>()[body]);
    }...};
    return calls[static_cast<std::size_t>(object.kind)](store, object.body, f);
  }(AllShapes{});
}

// The position of a shape in AllShapes.
template <class S>
inline constexpr BodyKind kKindOf = [] {
  std::uint8_t position = 0, found = 0;
  AllShapes::forEach([&]<class Each>() {
    if (std::is_same_v<Each, S>) found = position;
    ++position;
  });
  return BodyKind{found};
}();

// The first t > tMin at which the ray meets the shape; none beyond tMax if that is less work.
template <class S>
double firstWithin(const S& shape, const LocalRay& ray, double tMin, double tMax) {
  if constexpr (requires { shape.intersect(ray, tMin, tMax); })
    return shape.intersect(ray, tMin, tMax);
  else
    return shape.intersect(ray, tMin);
}

class RayIntersector {
 public:
  // `ray` in the space of the container; it must outlive the probe.
  RayIntersector(const Model& model, const LocalRay& ray, const Moment& moment)
      : model_(model), ray_(ray), moment_(moment) {}

  // The first t > tMin at which the ray meets the object, in world units; `tMax` is a hint that may be ignored.
  double intersect(const Target& target, double tMin, double tMax = kNoHit) {
    if (target.node == 0 && ray_.scale == 1) [[likely]] {
      if (target.kind == kKindOf<Sphere>)
        return model_.store().shapes<Sphere>()[target.body].intersect(ray_, tMin);
      if (target.kind == kKindOf<Triangle>)
        return model_.store().shapes<Triangle>()[target.body].intersect(ray_, tMin);
    }
    return intersectAny(target, tMin, tMax);
  }

 private:
  double intersectAny(const Target& target, double tMin, double tMax);
  const LocalRay& rayIn(NodeIndex node);

  const Model& model_;
  const LocalRay& ray_;
  Moment moment_;
  // Many objects in a row share a node: the last local ray is kept.
  NodeIndex lastNode_ = 0;
  LocalRay lastRay_;
};

// The nearest hit with tMin < t < tExit; `ray` in the space of the region.
Hit nearestHit(const Model& model, const Region& region, const LocalRay& ray, const Moment& moment,
               double tMin, double tExit);

// The one at exactly t, of several there the one that is taken.
Hit hitAt(const Model& model, const Region& region, const LocalRay& ray, const Moment& moment, double t);

}  // namespace rayshade
