// The first pass over a scene: how large it is, without keeping it.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <utility>

#include "rayshade/scene/object_stream.h"
#include "rayshade/space/bounds_sample.h"
#include "rayshade/space/density.h"

namespace rayshade {

// What no cut can share out: who needs a part of it holds all of it.
enum class Whole : std::uint8_t { csg, named, heightField, image };
struct WholeThings {
  std::uint64_t count = 0, bytes = 0, largest = 0;  // the largest in bytes
  void add(std::uint64_t size) {
    ++count;
    bytes += size;
    largest = std::max(largest, size);
  }
};

struct Survey {
  std::uint64_t objects = 0;         // of the world
  std::uint64_t bytes = 0;           // that they take in the memory of tasks, with what they use
  std::uint64_t everywhere = 0;      // of that, what is unbounded: every task has it
  Bounds world;                      // of the bounded ones, at the exposure of the survey
  DensityGrid density;               // of all of them, for cutting space into cells
  BoundsSample sample;               // of the bounded ones, for predicting where the work will be
  BoundsSample held{1 << 16};        // of the bounded ones by their bytes, for sharing out memory
  std::array<WholeThings, 4> whole;  // by Whole
  bool moves = false;                // something moves: another exposure needs another survey
};

class SurveySink : public SceneSink {
 public:
  explicit SurveySink(const Exposure& exposure)
      : stream_(exposure,
                [this](const SceneObject& object, const Bounds& bounds, std::span<const NodeItem* const>,
                       const ObjectStream::Brought& brought) { count(object, bounds, brought); }) {}

  void surface(SurfaceId, const Surface&) override {}
  void node(NodeId id, SceneNode node) override;
  void object(SceneObject object) override;
  void endOfStatement() override { stream_.endOfStatement(); }

  // When all was read, once: nothing of it stays here.
  Survey survey() {
    survey_.objects = stream_.objects();
    return std::move(survey_);
  }

 private:
  void count(const SceneObject& object, const Bounds& bounds, const ObjectStream::Brought& brought);

  Survey survey_;
  ObjectStream stream_;
};

}  // namespace rayshade
