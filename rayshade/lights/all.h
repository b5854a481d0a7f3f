// The closed list of lights.  Append only: the position is the tag on the wire.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/type_list.h"
#include "rayshade/lights/area.h"
#include "rayshade/lights/directional.h"
#include "rayshade/lights/extended.h"
#include "rayshade/lights/point.h"
#include "rayshade/lights/spot.h"

namespace rayshade {

using AllLights = TypeList<PointLight, DirectionalLight, ExtendedLight, AreaLight, SpotLight>;
using AnyLight = AllLights::Variant;

// The compiler names what is missing; what a light must have is said at the head of light.h.
static_assert((AllLights::forEach([]<Light L>() {}), true));

// A light of the scene.
struct LightSource {
  AnyLight kind;
  Color color = kWhite;
  bool castsShadows = true;
};

inline int pointsOf(const LightSource& light) {
  return std::visit([](const auto& kind) { return kind.points(); }, light.kind);
}
// Nothing: its points are not random.
inline std::optional<LightExtent> extentOf(const LightSource& light, Vec3 position) {
  return std::visit(
      [&]<class L>(const L& kind) -> std::optional<LightExtent> {
        if constexpr (LightWithExtent<L>) return kind.extent(position);
        return std::nullopt;
      },
      light.kind);
}
inline bool isRandom(const LightSource& light) { return extentOf(light, {}).has_value(); }
inline LightSample sampleLight(const LightSource& light, const LightQuery& query, int index) {
  return std::visit([&](const auto& kind) { return kind.sample(query, index); }, light.kind);
}

template <class Archive>
void serialize(Archive& archive, LightSource& l) {
  archive(l.kind, l.color, l.castsShadows);
}

}  // namespace rayshade
