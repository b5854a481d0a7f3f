// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/features.h"

#include <numeric>

namespace rayshade {
std::uint64_t SceneFeatures::shapeCount() const {
  return std::accumulate(shapes.begin(), shapes.end(), std::uint64_t{0});
}
std::uint64_t SceneFeatures::textureCount() const {
  return std::accumulate(textures.begin(), textures.end(), std::uint64_t{0});
}

void FeatureSink::count(const Surface& s) {
  features_.transparent += s.transparency > kNegligible ? 1 : 0;
  features_.reflecting += anyAbove(s.reflect * s.specular, kNegligible) ? 1 : 0;
  features_.attenuating += s.extinct != 1 ? 1 : 0;
}

void FeatureSink::surface(SurfaceId, const Surface& surface) {
  count(surface);
  features_.shadowTransparent += surface.transparency >= kNegligible ? 1 : 0;
}

void FeatureSink::count(const SceneNode& node) {
  features_.transforms += node.transforms.empty() ? 0 : 1;
  features_.moving += node.transforms.moves() ? 1 : 0;
  for (const PlacedTexture& placed : node.textures) {
    ++features_.textures[placed.texture.index()];
    features_.moving += placed.transforms.moves() ? 1 : 0;
    std::visit(
        [this]<class T>(const T& texture) {
          features_.coordinateTextures += T::needs == TextureNeeds::coordinates ? 1 : 0;
          features_.transparent += T::makesTransparent ? 1 : 0;
          if (const Surface* brought = texture.otherSurface()) count(*brought);
        },
        placed.texture);
  }
}

void FeatureSink::count(const SceneObject& object) {
  if (const AnyShape* shape = std::get_if<AnyShape>(&object.body)) {
    ++features_.shapes[shape->index()];
    features_.unbounded += std::visit([](const auto& s) { return s.bounds().finite() ? 0 : 1; }, *shape);
  } else if (std::holds_alternative<Instance>(object.body)) {
    ++features_.instances;
  } else {
    ++features_.csgOperations;
  }
}

}  // namespace rayshade
