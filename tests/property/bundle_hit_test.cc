// Rays in bundles get the answers that they get alone.
//
// Bundles of all sizes, from alike rays (as from one eye) to rays that have nothing in common, through random
// scenes with all kinds of objects, glass and motion among them.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/bundle_hit.h"

#include <gtest/gtest.h>

#include "rayshade/intersect/ray_hit.h"
#include "rayshade/trace/render.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

// Rays from one point into directions that differ by `spread`; each component may be exactly 0.
std::vector<Ray> raysOf(Random& numbers, std::size_t count, double spread) {
  std::vector<Ray> rays(count);
  const Vec3 eye = numbers.point(-8, 8), middle = numbers.point(-1, 1);
  for (Ray& ray : rays) {
    ray.origin = eye + spread * numbers.point(-1, 1);
    Vec3 direction = middle + spread * numbers.point(-1, 1);
    if (numbers.real(0, 1) < 0.1) direction.x = 0;
    if (numbers.real(0, 1) < 0.1) direction.z = -0.0;
    ray.direction = normalize(direction);
    ray.moment = {numbers.real(0, 1), 0};
  }
  // Among them, now and then, one for which the accelerator's arithmetic is not made.
  if (numbers.real(0, 1) < 0.3) {
    const Vec3 strange[] = {
        {1e200, -3, 1e-200}, {-1e32, 1e31, 1e32}, {kInfinity, 0, 0}, {std::nan(""), 1, 2}};
    rays[count / 2].origin = strange[static_cast<std::size_t>(numbers.real(0, 4))];
  }
  return rays;
}

// Every object is asked, whatever its box.
Occlusion occlusionAlone(const Model& model, const Region& region, const Segment& segment) {
  RayIntersector intersector(model, segment.ray, segment.moment);
  Occlusion met;
  for (const Target& target : region.objects)
    if (intersector.intersect(target, segment.tMin) < segment.tMax)
      (target.opaque ? met.opaque : met.transparent) = true;
  return met;
}

TEST(Bundle, EveryRayFindsWhatItFindsAlone) {
  std::size_t found = 0, stopped = 0, filtered = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Job job = jobOfText(randomScene(seed));
    Scene scene;
    const SceneHead head = job.read(scene.model.store());
    scene.settings = head.settings;
    scene.prepare(exposureOf(head.picture, 0));
    const Region& space = *scene.whole(1, RayKind::nearest)[0].region;
    SeededRandom numbers(seed);
    for (std::size_t round = 0; round < 24; ++round) {
      const double spreads[] = {0.01, 0.3, 3};
      const std::vector<Ray> rays =
          raysOf(numbers, 1 + (seed * 7 + round * 5) % kBundleSize, spreads[round % 3]);
      std::vector<Segment> segments;
      for (const Ray& ray : rays) {
        const double begin = round % 2 == 0 ? 0 : numbers.real(0, 2);
        segments.push_back(Segment(ray, begin, round % 4 < 2 ? kInfinity : begin + numbers.real(0, 12)));
      }
      // What is compiled for lesser processors than this one, too.
      for (int lesser = 0; lesser <= static_cast<int>(thisProcessor()); ++lesser) {
        const Processor processor{static_cast<std::uint8_t>(lesser)};
        std::vector<Hit> hits(rays.size());
        std::vector<Segment> lowered = segments;
        nearestHits(scene.model, space, lowered, hits, processor);
        std::vector<Occlusion> met(rays.size());
        std::vector<Segment> unchanged = segments;
        occlusions(scene.model, space, unchanged, met, processor);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          SCOPED_TRACE(testing::Message()
                       << "seed " << seed << " round " << round << " ray " << i << " processor " << lesser);
          ASSERT_EQ(lowered[i].tMax, std::min(hits[i].t, segments[i].tMax));
          const Hit alone = nearestHit(scene.model, space, rays[i], segments[i].tMin, segments[i].tMax);
          ASSERT_EQ(hits[i].t, alone.t);
          ASSERT_EQ(hits[i].object, alone.object);
          const Occlusion one = occlusionAlone(scene.model, space, segments[i]);
          found += alone.found();
          // The accelerator offers what has bounds to rays with finite origins only, and seen from very far all is at the end.
          if (!(maxAbs(rays[i].origin) < 1e30)) continue;
          ASSERT_EQ(met[i].opaque, one.opaque);
          if (!one.opaque) {
            ASSERT_EQ(met[i].transparent, one.transparent);
            filtered += one.transparent;
          }
          stopped += one.opaque;
        }
      }
    }
  }
  EXPECT_GT(found, 1000u);
  EXPECT_GT(stopped, 500u);
  EXPECT_GT(filtered, 50u);
}

}  // namespace
}  // namespace rayshade
