// Clouds as a layer: opaque where fractional Brownian motion is strong.
//
//   sky scale H lambda octaves opaque clear
//
// The motion f, brought to about [0, 1], becomes an intensity I that is 0 at `clear` and 1 at `opaque`;
// I^scale (I itself if scale is 0) scales ambient and diffuse, and the rest is transparent.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/elementary.h"
#include "rayshade/base/noise.h"
#include "rayshade/textures/fractal.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Sky {
  double exponent = 0;
  Spectrum spectrum;
  double opaque = 1, clear = 0;

  static constexpr std::string_view keyword = "sky";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = true;
  static constexpr std::string_view examples[] = {"2 0.5 2 4 0.8 0.3"};

  static std::optional<Sky> parse(Arguments& in) {
    Sky sky;
    sky.exponent = in.number();
    sky.spectrum = parseSpectrum(in);
    sky.opaque = in.number();
    sky.clear = in.number();
    return sky;
  }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const double f = fractionalMotion(hit.position, spectrum);
    const double share = 0.5 + 0.5 * f * (1 - spectrum.omega);  // f is at most about 1 / (1 - omega)
    double intensity = unitInterval((share - clear) / (opaque - clear));
    // An exponent below 0 makes bright clouds.  differs from rayshade4: 0 becomes so much and not infinity.
    constexpr double kBrightest = 1e6;
    if (exponent != 0) intensity = std::min(elementary::pow(intensity, exponent), kBrightest);
    hit.surface.transparency = 1 - intensity;
    scaleAmbientAndDiffuse(hit.surface, intensity);
  }
};

template <class Archive>
void serialize(Archive& archive, Sky& s) {
  archive(s.exponent, s.spectrum, s.opaque, s.clear);
}

}  // namespace rayshade
