// The first pass over a scene: how large it is, without keeping it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/scene/object_stream.h"
#include "rayshade/space/density.h"
#include "rayshade/space/sketch.h"

namespace rayshade {

struct Survey {
  std::uint64_t objects = 0;  // of the world
  Bounds world;               // of the bounded ones, at the exposure of the survey
  DensityGrid density;        // of all of them, for cutting space into cells
  Sketch sketch;              // of the bounded ones, for predicting where the work will be
  bool moves = false;         // something moves: another exposure needs another survey
};

class SurveySink : public SceneSink {
 public:
  explicit SurveySink(const Exposure& exposure)
      : stream_(exposure,
                [this](const SceneObject&, const Bounds& bounds, std::span<const FrameItem* const>) {
                  if (bounds.finite()) survey_.world = join(survey_.world, bounds);
                  survey_.density.add(bounds);
                  survey_.sketch.add(bounds);
                }) {}

  void surface(SurfaceId, const Surface&) override {}
  void frame(FrameId id, Frame frame) override {
    survey_.moves = survey_.moves || frame.transforms.moves();
    stream_.frame(id, std::move(frame));
  }
  void object(SceneObject object) override { stream_.object(std::move(object)); }
  void settled() override { stream_.settled(); }

  Survey survey() const {
    Survey done = survey_;
    done.objects = stream_.objects();
    return done;
  }

 private:
  Survey survey_;
  ObjectStream stream_;
};

}  // namespace rayshade
