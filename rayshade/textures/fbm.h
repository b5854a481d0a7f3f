// Scales ambient and diffuse by fractional Brownian motion f, or colours by it.
//
//   fbm offset scale H lambda octaves threshold [COLORMAP]
//
// The value is `offset` below the threshold, else offset + scale (f - threshold); 1 is the map's last entry.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/textures/colormap.h"
#include "rayshade/textures/fractal.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Fbm {
  double offset = 0, scale = 1;
  Spectrum spectrum;
  double threshold = 0;
  std::optional<Colormap> colormap;

  static constexpr std::string_view keyword = "fbm";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {"0.25 1.2 0.5 2 5 -0.4"};

  static std::optional<Fbm> parse(Arguments& in) {
    Fbm fbm;
    fbm.offset = in.number(kFactor);
    fbm.scale = in.number(kFactor);
    fbm.spectrum = parseSpectrum(in);
    fbm.threshold = in.number();
    if (in.fileNameFollows()) fbm.colormap = parseColormap(in);
    return fbm;
  }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const double f = fractionalMotion(hit.position, spectrum);
    const double value = f < threshold ? offset : offset + scale * (f - threshold);
    if (colormap)
      scaleAmbientAndDiffuse(hit.surface, colormap->at(255 * value));
    else
      scaleAmbientAndDiffuse(hit.surface, value);
  }
};

template <class Archive>
void serialize(Archive& archive, Fbm& f) {
  archive(f.offset, f.scale, f.spectrum, f.threshold, f.colormap);
}

}  // namespace rayshade
