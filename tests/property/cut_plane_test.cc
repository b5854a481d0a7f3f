// What ends right at a cut of space is found by whoever has either side.
//
// A hit counts in the voxel in which its t lies, and t is rounded: it may come out on the other side of the cut than the
// object, which then must be there, too.  That is what bounds are padded for: without, rays are lost here.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "rayshade/trace/render.h"
#include "rayshade/trace/trace_rays.h"
#include "tests/support/render_text.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

// Shapes that end at x = `at` within (y, z) +- 0.4, on the side to which `side` points.
std::string shapesAt(double at, double side, double y, double z, int kind) {
  std::ostringstream text;
  text.precision(17);
  const double far = at + side * 0.7, middle = at + side * 0.35;
  switch (kind) {
    case 0:
      text << "box " << std::min(at, far) << ' ' << y - .4 << ' ' << z - .4 << ' ' << std::max(at, far) << ' '
           << y + .4 << ' ' << z + .4;
      break;
    case 1:
      text << "sphere 0.35 " << middle << ' ' << y << ' ' << z;
      break;
    case 2:
      text << "disc 0.4 " << at << ' ' << y << ' ' << z << " 1 0 0";
      break;
    case 3:
      text << "triangle " << at << ' ' << y - .4 << ' ' << z - .4 << "  " << at << ' ' << y + .4 << ' '
           << z - .4 << "  " << at << ' ' << y << ' ' << z + .4;
      break;
    case 4:
      text << "polygon " << at << ' ' << y - .4 << ' ' << z - .4 << "  " << at << ' ' << y + .4 << ' '
           << z - .4 << "  " << at << ' ' << y + .4 << ' ' << z + .4 << "  " << at << ' ' << y - .4 << ' '
           << z + .4;
      break;
    default:
      text << "cylinder 0.3 " << middle << ' ' << y - .4 << ' ' << z << "  " << middle << ' ' << y + .4 << ' '
           << z;
  }
  text << '\n';
  return text.str();
}

Hit hitOf(Scene& scene, const Ray& ray) {
  FoundHits found;
  TraceCounts counts;
  traceRays(scene, std::span(&ray, 1), {}, found, counts);
  return found.hits[0];
}

TEST(CutPlane, WhatEndsAtACutIsFoundOnBothSides) {
  constexpr std::array kOff{0.0, 1e-17, 1e-16, 1e-15, 1e-14, 1e-12};
  std::size_t found = 0, rays = 0;
  for (const double side : {-1.0, 1.0}) {
    for (const double off : kOff) {
      // The corners put the cut at x = 0, exactly; the next ones at y = 0 and z = 0.
      std::string text = "sphere .1 -4.9 -4.9 -4.9 sphere .1 4.9 4.9 4.9\n";
      for (int kind = 0; kind < 6; ++kind) text += shapesAt(side * off, side, kind - 2.5, 0.5, kind);
      Scene whole, cut[3];
      const Job job = jobOfText(text);
      job.read(whole.model.store());
      whole.prepare({});
      for (std::uint32_t i = 0; i < 3; ++i) {
        job.read(cut[i].model.store());
        cut[i].prepare({}, 2u << i);
      }
      SeededRandom numbers(static_cast<std::uint64_t>(off * 1e18) + (side > 0));
      for (int n = 0; n < 20000; ++n) {
        Ray ray;
        ray.origin = numbers.point(-20, 20);
        const Vec3 target{side * off, numbers.real(-3, 3), numbers.real(0.1, 0.9)};
        ray.direction = normalize(target - ray.origin);
        const Hit expected = hitOf(whole, ray);
        found += expected.found();
        ++rays;
        for (Scene& scene : cut) {
          const Hit hit = hitOf(scene, ray);
          ASSERT_EQ(hit.object, expected.object)
              << "off by " << side * off << ", ray " << n << ", " << voxelCount(scene.tree()) << " voxels";
          ASSERT_EQ(hit.t, expected.t);
        }
      }
    }
  }
  EXPECT_GT(found, rays / 3);
}

}  // namespace
}  // namespace rayshade
