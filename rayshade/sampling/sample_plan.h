// The random numbers of the samples of a pixel, in pairs: how they are spread, and which pair is whose.
//
//   nets     all samples of a pixel have the same keys, and are the points of one net in many coordinates (digital_net.h): place in
//            the pixel, lens, moment, lights and gloss know of each other
//   strata   rayshade's: each sample has keys of its own, and each use its own side x side strata in another order
//
// What is multiplied with each other must have coordinates of its own; lights are only added, so all of them share a pair, each
// light at each hit with another scrambling.  The first four coordinates fit each other best, so a scene without a lens gives
// its lights what the lens would have had.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/digital_net.h"

namespace rayshade {

inline constexpr std::int32_t kMaxSamplesPerSide = DigitalNet::kMostSide;

enum class Sampling : std::uint8_t { nets, strata };

// The first coordinate of each; 0 and 1 are the place in the pixel.
struct SampleUses {
  std::uint8_t lens = 2, light = 2, time = 2, gloss = 2;  // gloss: a pair for each depth from there on
  friend bool operator==(const SampleUses&, const SampleUses&) = default;
};
inline SampleUses sampleUses(bool lens, bool light, bool time) {
  SampleUses uses;
  uses.light = static_cast<std::uint8_t>(uses.lens + (lens ? 2 : 0));
  uses.time = static_cast<std::uint8_t>(uses.light + (light ? 2 : 0));
  uses.gloss = static_cast<std::uint8_t>(uses.time + (time ? 2 : 0));
  return uses;
}

struct SamplePlan {
  std::int32_t side = 1;  // of a pixel, in samples
  Sampling sampling = Sampling::nets;
  SampleUses uses{};

  // Where a sample lies in a square.  `number`: that of the ray; `key`: of its path; `coordinate`: from `uses`; x, y: what the
  // numbers are for; `index` tells apart several squares of one use.
  SquarePoint anywhere(std::int32_t number, RandomKey key, std::uint32_t coordinate, Dimension x, Dimension y,
                       std::uint32_t index = 0) const {
    if (sampling == Sampling::nets) return inNet(number, key, coordinate, x, index);
    return {uniform(key, x, index), uniform(key, y, index)};
  }
  // The same, in the sample's stratum: column number % side, row number / side.
  SquarePoint inStratum(std::int32_t number, RandomKey key, std::uint32_t coordinate, Dimension x,
                        Dimension y, std::uint32_t index = 0) const {
    if (sampling == Sampling::nets) return inNet(number, key, coordinate, x, index);
    return {(number % side + uniform(key, x, index)) / side, (number / side + uniform(key, y, index)) / side};
  }

 private:
  SquarePoint inNet(std::int32_t number, RandomKey key, std::uint32_t coordinate, Dimension use,
                    std::uint32_t index) const {
    return DigitalNet::of(side).square(static_cast<std::uint32_t>(number), coordinate,
                                       useKey(key, use, index));
  }
};

template <class Archive>
void serialize(Archive& archive, SampleUses& u) {
  archive(u.lens, u.light, u.time, u.gloss);
}
template <class Archive>
void serialize(Archive& archive, SamplePlan& p) {
  archive(p.side, p.sampling, p.uses);
  if constexpr (Archive::kReading) {
    if (p.side < 1 || p.side > kMaxSamplesPerSide) {
      p.side = 1;
      archive.fail();
    }
  }
}

}  // namespace rayshade
