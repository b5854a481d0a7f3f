// The eye: screen positions to primary rays.
//
// With L the distance to the target, d the line of sight, i to the right and j up, the screen stands at the target:
// sx = i 2 L tan(hfov/2) / width, and sy likewise, downwards.  The vertical angle, when it is not given, is
// horizontal * height / width, linear in the angle (rayshade's rule).  Stereo moves the eye by half of the
// separation along i and looks at the same target (toe-in).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/optics/ray.h"
#include "rayshade/sampling/sampler.h"
#include "rayshade/scene/settings.h"

namespace rayshade {

// The camera of one picture, worked out.  World space.
struct View {
  Vec3 eye;
  Vec3 first;              // from the eye to the upper left corner of the screen
  Vec3 right, down;        // one pixel
  Vec3 lensRight, lensUp;  // the half width of the lens along i and j; zero for a pinhole
  double focalDistance = 0;
};

// Nothing when the line of sight is zero or parallel to `up`.
std::optional<View> viewOf(const Camera& camera, const PictureSpec& picture);

// The ray of a sample.
Ray primaryRay(const View& view, const SamplePosition& at, std::int32_t frame);

// The rays of many samples, the same as one by one.  `frame` counts from 0, as for samplePosition().
void primaryRays(const View& view, const PictureSpec& picture, std::uint64_t seed, std::int32_t frame,
                 std::span<const SampleId> samples, std::vector<Ray>& rays);

// What is asked for: from here to rays of samples.
struct FrameRequest {
  View view;
  PictureSpec picture;
  std::uint64_t seed = 0;
};

template <class Archive>
void serialize(Archive& archive, View& v) {
  archive(v.eye, v.first, v.right, v.down, v.lensRight, v.lensUp, v.focalDistance);
}
template <class Archive>
void serialize(Archive& archive, FrameRequest& r) {
  archive(r.view, r.picture, r.seed);
}

}  // namespace rayshade
