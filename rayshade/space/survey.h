// The first pass over a scene: how large it is, without keeping it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/scene/object_stream.h"
#include "rayshade/space/bounds_sample.h"
#include "rayshade/space/density.h"

namespace rayshade {

struct Survey {
  std::uint64_t objects = 0;  // of the world
  Bounds world;               // of the bounded ones, at the exposure of the survey
  DensityGrid density;        // of all of them, for cutting space into cells
  BoundsSample sample;        // of the bounded ones, for predicting where the work will be
  bool moves = false;         // something moves: another exposure needs another survey
};

class SurveySink : public SceneSink {
 public:
  explicit SurveySink(const Exposure& exposure)
      : stream_(exposure, [this](const SceneObject&, const Bounds& bounds, std::span<const NodeItem* const>) {
          if (bounds.finite()) survey_.world = join(survey_.world, bounds);
          survey_.density.add(bounds);
          survey_.sample.add(bounds);
        }) {}

  void surface(SurfaceId, const Surface&) override {}
  void node(NodeId id, SceneNode node) override {
    survey_.moves = survey_.moves || node.transforms.moves();
    stream_.node(id, std::move(node));
  }
  void object(SceneObject object) override { stream_.object(std::move(object)); }
  void endOfStatement() override { stream_.endOfStatement(); }

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
