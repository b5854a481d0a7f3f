// Clouds on a unit sphere around the origin, thinner towards the limb.
//
//   cloud scale H lambda octaves centre limb softness
//
// `scale` is the contrast inside of a cloud; `centre` and `limb` are the intensities above which there is
// cloud in the middle of the visible disc and at its edge; over `softness` above that it becomes opaque.
//
// Source: G. Y. Gardner, Visual Simulation of Clouds, SIGGRAPH 1985.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/textures/fractal.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Cloud {
  double scale = 1;
  Spectrum spectrum;
  double centre = 0, limb = 0, softness = 1;

  static constexpr std::string_view keyword = "cloud";
  static constexpr TextureNeeds needs = TextureNeeds::ray;
  static constexpr bool makesTransparent = true;
  static constexpr std::string_view examples[] = {"0.7 0.5 2 6 0.35 0.75 0.3"};

  static std::optional<Cloud> parse(Arguments& in) {
    Cloud cloud;
    cloud.scale = in.number(kFactor);
    cloud.spectrum = parseSpectrum(in);
    cloud.centre = in.number();
    cloud.limb = in.number();
    cloud.softness = in.number();
    return cloud;
  }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const double squaredDistance = dot(hit.rayOrigin, hit.rayOrigin);
    if (squaredDistance < 1 + kNegligible) {  // seen from inside: nothing
      hit.surface.transparency = 1;
      scaleAmbientAndDiffuse(hit.surface, 0);
      return;
    }
    const double intensity = unitInterval(0.5 - spectrum.hurst * fractionalMotion(hit.position, spectrum));
    const double distance = std::sqrt(squaredDistance);
    // Cosines at the eye, from the direction of the centre: of the limb and of the ray.
    const double ofLimb = std::sqrt(squaredDistance - 1) / distance;
    const double ofRay = -dot(hit.rayOrigin, hit.rayDirection) / distance;
    const double central =
        ofLimb < 1 ? (ofRay - ofLimb) / (1 - ofLimb) : 1.0;  // 1 in the middle, 0 at the limb
    const double threshold = centre + (limb - centre) * (1 - central);
    const double transparency = unitInterval(1 - (intensity - threshold) / softness);
    hit.surface.transparency = transparency;
    hit.surface.ambient = hit.surface.ambient * (1 - transparency);
    hit.surface.diffuse = hit.surface.diffuse * ((1 - transparency) * (1 - scale + scale * intensity));
  }
};

template <class Archive>
void serialize(Archive& archive, Cloud& c) {
  archive(c.scale, c.spectrum, c.centre, c.limb, c.softness);
}

}  // namespace rayshade
