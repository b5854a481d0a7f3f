// Waves on water that the wind blows here and there.
//
//   windy scale wind cat base octaves frequency amplitude offset
//
// Vector noise of height `base` plus octaves of it, each `frequency` times finer and `amplitude` times lower
// than the one before, times the wind plus `offset`, bend the normal by `scale`.  The wind is a turbulence of
// frequency `wind` and height `cat`, or 1 everywhere if `cat` is 0; the octaves also start at its strength.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/noise.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct Windy {
  double scale = 0;
  double windFrequency = 0, windStrength = 0;
  double base = 0;
  int octaves = 0;
  double frequency = 2, amplitude = 0.5;
  double offset = 0;

  static constexpr std::string_view keyword = "windy";
  static constexpr TextureNeeds needs = TextureNeeds::position;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {"0.3 0.5 0 0.8 4 2.1 0.6 0.5",
                                                  "0.3 0.5 2 0.8 4 2.1 0.6 0.5"};

  static std::optional<Windy> parse(Arguments& in) {
    Windy windy;
    windy.scale = in.number();
    windy.windFrequency = in.number();
    windy.windStrength = in.number();
    windy.base = in.number();
    windy.octaves = in.integer();
    windy.frequency = in.number();
    windy.amplitude = in.number();
    windy.offset = in.number();
    return windy;
  }

  const Surface* otherSurface() const { return nullptr; }
  void apply(TextureHit& hit) const {
    const double wind = windStrength == 0 ? 1.0 : windStrength * chaos(windFrequency * hit.position, 7);
    Vec3 waves = base * vectorNoise(hit.position);
    double finer = 1, lower = wind;
    for (int i = 0; i < std::min(octaves, kMostOctaves); ++i) {
      finer *= frequency;
      waves = waves + lower * vectorNoise(finer * hit.position);
      lower *= amplitude;
    }
    hit.normal = bend(hit.normal, scale * (wind + offset) * waves);
  }
};

template <class Archive>
void serialize(Archive& archive, Windy& w) {
  archive(w.scale, w.windFrequency, w.windStrength, w.base, w.octaves, w.frequency, w.amplitude, w.offset);
}

}  // namespace rayshade
