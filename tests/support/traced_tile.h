// Small pictures, and tiles whose samples get their colours from a function.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/sampling/sampler.h"

namespace rayshade {

inline PictureSpec specOf(std::int32_t width, std::int32_t height, std::int32_t side) {
  PictureSpec spec;
  spec.width = width;
  spec.height = height;
  spec.samplesPerSide = side;
  return spec;
}

template <class ColorOf>
TileColors tracedTile(const SamplingRules& rules, const Tile& tile, ColorOf&& colorOf) {
  TileSampler samples(rules, tile);
  SampleId id;
  while (samples.next(std::span(&id, 1)) == 1) samples.supply(id, colorOf(id));
  return samples.colors();
}

// Supplies the next tile, or the next sample that no tile has traced; false: there is none now.
template <class ColorOf>
bool supplyNext(Sampler& sampler, ColorOf&& colorOf) {
  SampleId id;
  if (sampler.nextSamples(std::span(&id, 1)) == 1) {
    sampler.supply(id, colorOf(id));
    return true;
  }
  const std::optional<Tile> tile = sampler.nextTile();
  if (tile) sampler.supply(*tile, tracedTile(sampler.rules(), *tile, colorOf));
  return tile.has_value();
}

}  // namespace rayshade
