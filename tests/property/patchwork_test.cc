// What a patchwork calls settled is what one process finds that has everything, whichever patches are missing.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/patchwork.h"

#include <gtest/gtest.h>

#include "rayshade/language/parser.h"
#include "rayshade/space/voxel_bounds.h"
#include "tests/support/random_scene.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

constexpr Exposure kExposure{0.25, 0.75, 0};

// A random scene in cells, some of which are here.
class Cells : public PatchSource {
 public:
  Cells(std::uint64_t seed, double here) {
    parseSceneText(randomScene(seed), "text", {}, model.store());
    model.prepare(kExposure);
    Bounds world;
    DensityGrid density;
    const auto objects = model.store().objectsOf(kWorld);
    for (ObjectIndex object : objects) {
      const Bounds bounds = model.boundsOf(object);
      if (bounds.finite()) world = join(world, bounds);
      density.add(bounds);
    }
    tree = buildBinTree(world, {2, 40}, density);
    std::vector<std::vector<ObjectIndex>> inCell(cellCount(tree));
    std::vector<Bounds> contents(cellCount(tree));
    for (ObjectIndex object : objects) {
      std::vector<CellId> touched;
      cellsTouching(tree, model.boundsOf(object), touched);
      for (CellId cell : touched) {
        const auto at = static_cast<std::size_t>(cell);
        inCell[at].push_back(object);
        contents[at] = join(contents[at], boundsInCell(model.boundsOf(object), tree, cell));
      }
    }
    SeededRandom numbers(seed);
    std::vector<Bounds> boxes;
    for (std::size_t cell = 0; cell < inCell.size(); ++cell) {
      if (inCell[cell].empty()) continue;
      boxes.push_back(contents[cell]);
      regions_.push_back(model.regionOf(std::move(inCell[cell])));
      isHere_.push_back(numbers.real(0, 1) < here);
    }
    patchwork = Patchwork(std::move(boxes));
    everything = model.regionOf({objects.begin(), objects.end()});
  }
  RegionRef patch(std::uint32_t number, std::size_t rays) override {
    EXPECT_GT(rays, 0u);
    return isHere_[number] ? RegionRef{&model, &regions_[number]} : RegionRef{};
  }

  Model model;
  BinTree tree;
  Region everything;
  Patchwork patchwork;

 private:
  std::vector<Region> regions_;
  std::vector<bool> isHere_;
};

std::vector<Ray> bundle(Random& numbers, std::size_t count) {
  std::vector<Ray> rays(count);
  const Vec3 eye = numbers.point(-7, 7);
  const double spread = numbers.real(0, 1) < 0.5 ? 0.1 : 3;
  for (Ray& ray : rays) {
    ray.origin = eye;
    ray.direction = normalize(spread * numbers.point(-1, 1) - eye);
    ray.moment = {numbers.real(kExposure.opens, kExposure.closes), 0};
  }
  return rays;
}

TEST(Patchwork, WhatIsSettledIsRight) {
  std::size_t hits = 0, open = 0, dark = 0, clear = 0, missing = 0, filtered = 0;
  const std::vector<double> noBegin(kBundleSize, 0.0);
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const double shares[] = {0, 0.5, 0.9, 1};
    const double here = shares[seed % 4];
    Cells cells(seed, here);
    SeededRandom numbers(seed + 1000);
    for (std::size_t round = 0; round < 12; ++round) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " round " << round);
      const std::vector<Ray> rays = bundle(numbers, 1 + (seed + 5 * round) % kBundleSize);
      TraceCounts counts;
      std::vector<Segment> segments;
      std::vector<double> ends;
      for (const Ray& ray : rays) {
        ends.push_back(round % 3 == 0 ? kInfinity : numbers.real(1, 14));
        segments.push_back(Segment(ray, 0, ends.back()));
      }
      std::vector<Segment> shadows = segments;
      std::vector<Patchwork::Found> found(rays.size());
      cells.patchwork.visit(cells, segments, noBegin, found, counts);
      std::vector<Patchwork::Light> light(rays.size());
      cells.patchwork.obstruct(cells, shadows, noBegin, light, counts);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit hit = nearestHit(cells.model, cells.everything, rays[i], 0, ends[i]);
        ASSERT_TRUE(found[i].settled || here < 1);
        open += !found[i].settled;
        if (found[i].settled) {
          ASSERT_EQ(found[i].hit.t, hit.t);
          ASSERT_EQ(found[i].hit.object, hit.object);
          hits += hit.found();
        } else {
          ASSERT_GE(found[i].hit.t, hit.t);
        }
        ObjectIndex occluder = kNone;
        const Occlusion met = occlusion(cells.model, cells.everything, rays[i], 0, ends[i], occluder);
        switch (light[i]) {
          case Patchwork::Light::dark:
            ASSERT_TRUE(met.opaque);
            ++dark;
            break;
          case Patchwork::Light::clear:
            ASSERT_FALSE(met.opaque || met.transparent);
            ++clear;
            break;
          case Patchwork::Light::filtered:
            ASSERT_TRUE(met.transparent || met.opaque);
            ++filtered;
            break;
          case Patchwork::Light::missing:
            ASSERT_LT(here, 1);
            ++missing;
            break;
        }
      }
    }
  }
  for (std::size_t number : {hits, open, dark, clear, missing}) EXPECT_GT(number, 200u);
  EXPECT_GT(filtered, 20u);
}

TEST(Patchwork, ABoxIsMetFromWhereItBeginsToWhereItEnds) {
  const Bounds box{{2, -1, -1}, {3, 1, 1}};
  const LocalRay ray{{0, 0, 0}, {1, 0, 0}, 1};
  EXPECT_TRUE(mayMeet(box, ray, 0, kInfinity));
  EXPECT_TRUE(mayMeet(box, ray, 3, 3));
  EXPECT_TRUE(mayMeet(box, ray, 0, 2));
  EXPECT_FALSE(mayMeet(box, ray, 0, 1.999999));
  EXPECT_FALSE(mayMeet(box, ray, 3.000001, kInfinity));
  EXPECT_FALSE(mayMeet(box, {{0, 2, 0}, {1, 0, 0}, 1}, 0, kInfinity));
  EXPECT_TRUE(mayMeet({{2, -kInfinity, -1}, {3, kInfinity, 1}}, {{0, 1e30, 0}, {1, 0, 0}, 1}, 0, kInfinity));
}

}  // namespace
}  // namespace rayshade
