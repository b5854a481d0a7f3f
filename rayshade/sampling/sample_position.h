// Where and when a sample is taken: pure functions of the picture, the seed and the sample.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "rayshade/base/random.h"
#include "rayshade/sampling/picture_spec.h"

namespace rayshade {

struct SampleId {
  std::int32_t x = 0, y = 0;  // pixel of the screen, from the upper left; y may be one line below the screen
  std::int32_t cell = 0;      // of the pixel: column + row * side

  friend bool operator==(const SampleId&, const SampleId&) = default;
};

template <class Archive>
void serialize(Archive& archive, SampleId& s) {
  archive(s.x, s.y, s.cell);
}

// Where and when a sample is taken.
struct SamplePosition {
  double u = 0, v = 0;      // on the screen                                     [pixels]
  double time = 0;          // scene time
  std::int32_t number = 0;  // of the net; of strata, that of lens, time, lights and gloss
  RandomKey key{};          // with the number and the plan, all that is random about its rays comes from it
  SamplePlan plan;
};

// Where the ray of a sample goes through the lens, in the square [-1, 1]^2.
struct LensPosition {
  double x = 0, y = 0;
};
LensPosition lensPosition(const SamplePosition& at);

// The stratum of a cell 0..side^2-1.  As in rayshade 4 the numbers start from 1 for sides 6, 7 and 8, so one cell of each pixel has
// the number side^2, just outside of the square of strata.
std::int32_t sampleNumber(std::int32_t side, std::int32_t cell);

// A pure function: any task gets the same position.  `frame` counts from 0 at spec.startTime.
SamplePosition samplePosition(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
                              const SampleId& id);

// The same for many samples of one frame; `positions` is as long as `ids`.
void samplePositions(const PictureSpec& spec, std::uint64_t seed, std::uint32_t frame,
                     std::span<const SampleId> ids, std::span<SamplePosition> positions);

}  // namespace rayshade
