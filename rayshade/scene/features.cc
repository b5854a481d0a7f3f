// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/features.h"

#include <numeric>

namespace rayshade {
namespace {

// The surfaces that textures bring along.
template <class T>
const Surface* surfaceOf(const T&) {
  return nullptr;
}
const Surface* surfaceOf(const Checker& t) { return &t.odd; }
const Surface* surfaceOf(const Blotch& t) { return &t.other; }
const Surface* surfaceOf(const Stripe& t) { return &t.between; }
const Surface* surfaceOf(const ImageTexture& t) { return t.base ? &*t.base : nullptr; }

// Textures that make a surface transparent themselves.
template <class T>
constexpr bool kMakesTransparent = std::is_same_v<T, Cloud> || std::is_same_v<T, Sky>;

}  // namespace

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
          features_.transparent += kMakesTransparent<T> ? 1 : 0;
          if (const Surface* brought = surfaceOf(texture)) count(*brought);
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
