// One ray against the objects of one container: the inner loop.
//
// t is in world units everywhere; each object's local ray carries the scale between the two.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/space/model.h"

namespace rayshade {

// Calls f with the shape of an object that is neither instance nor CSG.
template <class F>
auto withShape(const SceneStore& store, const PlacedObject& object, F&& f) {
  return [&]<class... S>(TypeList<S...>) {
    using Result = std::common_type_t<decltype(f(std::declval<const S&>()))...>;
    Result result{};
    const std::size_t kind = static_cast<std::size_t>(object.kind);
    std::size_t i = 0;
    (void)((kind == i++ ? (result = f(store.shapes<S>()[object.body]), true) : false) || ...);
    return result;
  }(AllShapes{});
}

// Flat shapes replace a hit at the same distance in rayshade; unbounded ones are tested first.
bool isFlat(BodyKind kind);
bool isUnbounded(BodyKind kind);

enum class Opacity : std::uint8_t { opaque, transparent };
// Of the whole object: opaque if every surface bound in it lets no light through.
Opacity opacityOf(const Model& model, ObjectIndex object);

struct Probe {
  const Model& model;
  LocalRay ray;  // in the space of the container
  Moment moment;
  // Many objects in a row share a frame: the last local ray is kept.
  FrameIndex lastFrame = 0;
  LocalRay lastRay{};

  const LocalRay& rayIn(FrameIndex frame) {
    if (model.store().frame(frame).identity) return ray;
    if (frame != lastFrame) {
      lastRay = intoFrame(model.store(), frame, ray, moment);
      lastFrame = frame;
    }
    return lastRay;
  }

  // The first t > tMin at which the ray meets the object, in world units; `tMax` is a hint that may be ignored.
  double intersect(ObjectIndex index, double tMin, double tMax = kNoHit);
};

// The nearest hit with tMin < t < tExit; `ray` in the space of the region.
Hit nearestHit(const Model& model, const Region& region, const LocalRay& ray, const Moment& moment,
               double tMin, double tExit);

}  // namespace rayshade
