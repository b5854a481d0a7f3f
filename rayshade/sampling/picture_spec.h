// The picture that is wanted: its size, its samples, its moment.
//
// Plain numbers, as they stand in the scene file or on the command line; pixelArea() turns screen, window and
// crop into pixels and is where they are checked.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "rayshade/base/color.h"
#include "rayshade/sampling/sample_plan.h"

namespace rayshade {

inline constexpr std::int32_t kMaxPictureSide =
    65536;  // pixels: rows are held in memory, whatever a file says
inline constexpr std::int32_t kMostFrames = 1'000'000;  // each is a file

// Which pixels get all of their samples (cross_sweep.h); the others get one.
enum class Refinement : std::uint8_t {
  neighbours,  // those whose neighbours differ from each other: without bias
  crosses,  // those that differ from their neighbours, as rayshade has it: loses what is smaller than a pixel
  all,      // all of them
};

struct PixelFilter {
  bool gaussian = false;
  double width = 1;  // pixels; 1.8 when gaussian and not said otherwise
};

// The picture that is wanted.
struct PictureSpec {
  std::int32_t width = 512, height = 512;             // of the whole screen                  [pixels]
  std::optional<std::array<std::int32_t, 4>> window;  // x0 x1 y0 y1, inclusive; y from the top
  std::array<double, 4> crop{0, 1, 0, 1};             // left right bottom top, shares of the window
  std::int32_t samplesPerSide = 3;                    // side^2 samples in a pixel, 1..64
  Sampling sampling = Sampling::nets;
  SampleUses uses{};
  Refinement refinement = Refinement::crosses;
  bool jitter = true;
  PixelFilter filter;
  Color contrast{0.2, 0.15, 0.3};  // above it neighbours differ; black: all pixels get all samples
  double gamma = 1;
  std::int32_t frames = 1, firstFrame = 0;
  double frameLength = 1, startTime = 0, shutter = 0;  // scene time

  SamplePlan plan() const { return {samplesPerSide, sampling, uses}; }
};

// The pixels of the screen that are rendered; x to the right, y down.
struct PixelArea {
  std::int32_t x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const PixelArea&, const PixelArea&) = default;
};

// Nothing when the window is not on the screen or the screen is empty or too large.
// As in rayshade the "bottom" of a crop is the share that is nearer to row 0, which is the top of the
// picture.
inline std::optional<PixelArea> pixelArea(const PictureSpec& spec) {
  auto sensible = [](std::int32_t side) { return side >= 1 && side <= kMaxPictureSide; };
  if (!sensible(spec.width) || !sensible(spec.height)) return std::nullopt;
  const auto [x0, x1, y0, y1] =
      spec.window.value_or(std::array<std::int32_t, 4>{0, spec.width - 1, 0, spec.height - 1});
  if (x0 < 0 || x0 > x1 || x1 >= spec.width || y0 < 0 || y0 > y1 || y1 >= spec.height) return std::nullopt;

  auto share = [](double value) { return value > 0 ? std::min(value, 1.0) : 0.0; };  // not a number: 0
  auto cut = [&](std::int32_t low, std::int32_t high, double from, double to) {
    const auto [nearer, farther] = std::minmax({share(from), share(to)});
    const auto first = static_cast<std::int32_t>(low + nearer * (high - low));
    const auto last = static_cast<std::int32_t>(low + farther * (high - low));
    return std::array<std::int32_t, 2>{first, last - first + 1};
  };
  const auto [x, width] = cut(x0, x1, spec.crop[0], spec.crop[1]);
  const auto [y, height] = cut(y0, y1, spec.crop[2], spec.crop[3]);
  return PixelArea{x, y, width, height};
}

template <class Archive>
void serialize(Archive& archive, PixelFilter& f) {
  archive(f.gaussian, f.width);
}
// What samples and their rays depend on.
template <class Archive>
void serialize(Archive& archive, PictureSpec& p) {
  archive(p.width, p.height, p.window, p.crop, p.samplesPerSide, p.sampling, p.uses, p.refinement, p.jitter,
          p.filter, p.contrast, p.firstFrame, p.frameLength, p.startTime, p.shutter);
  if constexpr (Archive::kReading) {
    if (p.samplesPerSide < 1 || p.samplesPerSide > kMaxSamplesPerSide || p.sampling > Sampling::strata ||
        p.refinement > Refinement::all) {
      p = {};
      archive.fail();
    }
  }
}

}  // namespace rayshade
