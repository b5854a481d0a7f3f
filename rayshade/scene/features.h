// What a scene is made of, counted while it is read: the basis of plans.
//
// Things in definitions that nothing uses count, too: the numbers say what may occur, so that 0 is a promise.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "rayshade/scene/items.h"

namespace rayshade {

struct SceneFeatures {
  std::array<std::uint64_t, AllShapes::size> shapes{};      // by position in AllShapes
  std::array<std::uint64_t, AllTextures::size> textures{};  // by position in AllTextures
  std::uint64_t instances = 0, csgOperations = 0;
  std::uint64_t unbounded = 0;           // shapes of infinite extent
  std::uint64_t transforms = 0;          // nodes that transform
  std::uint64_t moving = 0;              // those among them that change with time
  std::uint64_t coordinateTextures = 0;  // textures that ask for u and v

  // Surfaces, those of textures among them, and textures that make a surface so.
  std::uint64_t transparent = 0;        // let rays through
  std::uint64_t shadowTransparent = 0;  // let light through in shadows: before textures
  std::uint64_t reflecting = 0;
  std::uint64_t attenuating = 0;  // extinct is not 1

  std::uint64_t shapeCount() const;
  std::uint64_t textureCount() const;
};

// Counts what it is given and keeps nothing.
class FeatureSink : public SceneSink {
 public:
  void surface(SurfaceId id, const Surface& surface) override;
  void node(NodeId, SceneNode node) override { count(node); }
  void object(SceneObject object) override { count(object); }
  void endOfStatement() override {}

  // For those who give them to somebody else, too.
  void count(const SceneNode& node);
  void count(const SceneObject& object);

  const SceneFeatures& features() const { return features_; }

 private:
  void count(const Surface& surface);

  SceneFeatures features_;
};

}  // namespace rayshade
