// Tracing with cells that were fetched finds what tracing with the whole voxels finds, bit for bit, wherever it was
// interrupted.
// guarded: borrows cells of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/local_trace.h"

#include <gtest/gtest.h>

#include <memory>

#include "rayshade/language/parser.h"
#include "rayshade/scene/extract.h"
#include "tests/support/random_scene.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

constexpr Exposure kExposure{0.25, 0.75, 0};

// A random scene, cut into voxels and cells.
class CutScene : public VoxelSource {
 public:
  explicit CutScene(std::uint64_t seed) {
    settings = parseSceneText(randomScene(seed), "text", {}, model.store()).settings;
    model.prepare(kExposure);
    Bounds world;
    DensityGrid density;
    const auto objects = model.store().objectsOf(kWorld);
    for (ObjectIndex object : objects) {
      const Bounds bounds = model.boundsOf(object);
      if (bounds.finite()) world = join(world, bounds);
      density.add(bounds);
    }
    tree = buildBinTree(world, {static_cast<std::uint32_t>(1 + seed % 6), 40}, density);
    std::vector<std::vector<ObjectIndex>> inVoxel(voxelCount(tree));
    inCell.resize(cellCount(tree));
    for (ObjectIndex object : objects) {
      std::vector<VoxelId> voxels;
      voxelsTouching(tree, model.boundsOf(object), voxels);
      for (VoxelId v : voxels) inVoxel[static_cast<std::size_t>(v)].push_back(object);
      std::vector<CellId> cells;
      cellsTouching(tree, model.boundsOf(object), cells);
      for (CellId c : cells) inCell[static_cast<std::size_t>(c)].push_back(object);
    }
    for (auto& list : inVoxel) regions_.push_back(model.regionOf(std::move(list)));
  }

  const Region* find(VoxelId voxel) const override { return &regions_[static_cast<std::size_t>(voxel)]; }

  Model model;
  SceneSettings settings;
  BinTree tree;
  std::vector<std::vector<ObjectIndex>> inCell;

 private:
  std::vector<Region> regions_;
};

// Has some voxels itself, and those cells of others that were fetched.
class Task final : public GroundSource {
 public:
  Task(const CutScene& scene, Random& random, double own) : scene_(scene), cells_(cellCount(scene.tree)) {
    for (std::uint32_t v = 0; v < voxelCount(scene.tree); ++v) own_.push_back(random.chance(own));
  }

  RegionRef voxel(VoxelId voxel) override {
    if (!own_[static_cast<std::size_t>(voxel)]) return {};
    return {&scene_.model, scene_.find(voxel)};
  }
  RegionRef cell(CellId cell) override {
    const auto& fetched = cells_[static_cast<std::size_t>(cell)];
    return fetched ? RegionRef{&fetched->model, &fetched->region} : RegionRef{};
  }
  bool has(CellId cell) const { return cells_[static_cast<std::size_t>(cell)] != nullptr; }
  // Over the wire, as another task would send it.
  void fetch(CellId cell) {
    Extract extract(scene_.model.store());
    for (ObjectIndex object : scene_.inCell[static_cast<std::size_t>(cell)]) extract.add(object);
    auto fetched = std::make_unique<Fetched>();
    fetched->model.take(decode<std::vector<Item>>(encode(extract.items)).value());
    fetched->model.prepare(kExposure);
    const auto objects = fetched->model.store().objectsOf(kWorld);
    fetched->region = fetched->model.regionOf({objects.begin(), objects.end()});
    EXPECT_EQ(fetched->model.leftOut(), 0u);
    cells_[static_cast<std::size_t>(cell)] = std::move(fetched);
  }
  void forget() {
    for (auto& cell : cells_) cell.reset();
  }

 private:
  struct Fetched {
    Model model;
    Region region;
  };
  const CutScene& scene_;
  std::vector<bool> own_;
  std::vector<std::unique_ptr<Fetched>> cells_;
};

Ray randomRay(Random& random) {
  Ray ray;
  ray.origin = random.point(-6, 6);
  ray.direction = random.chance(0.7) ? normalize(random.point(-2, 2) - ray.origin) : random.direction();
  if (random.chance(0.1)) ray.direction = {0, 0, -1};
  ray.moment = {random.real(kExposure.opens, kExposure.closes), 0};
  return ray;
}

// Follows with what is at hand, fetching what is missing; every cell that is asked for is on the ray's walk.
template <class Follow>
LocalProgress followFetching(const CutScene& scene, Task& task, Random& random, Follow follow) {
  for (;;) {
    const LocalProgress progress = follow();
    if (progress.state != LocalProgress::State::missing) return progress;
    EXPECT_FALSE(task.has(progress.cell));
    EXPECT_EQ(voxelOfCell(scene.tree, progress.cell), progress.voxel);
    if (random.chance(0.2)) task.forget();  // what was visited is not asked for again
    task.fetch(progress.cell);
  }
}

ObjectId idOf(const Model& model, const Hit& hit) { return model.store().object(hit.object).id; }

TEST(LocalTrace, FindsWhatTheVoxelsFind) {
  int hits = 0, misses = 0, fetched = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const CutScene scene(seed);
    SeededRandom random(seed);
    Task task(scene, random, 0.4);
    for (int i = 0; i < 25; ++i) {
      const Ray ray = randomRay(random);
      TraceCounts counts;
      const Progress expected = followRay(scene.tree, scene.model, scene, ray, 0, counts);
      std::uint32_t unit = 0;
      const LocalProgress got = followFetching(scene, task, random, [&] {
        ++fetched;
        return followLocally(scene.tree, task, ray, unit, counts);
      });
      ASSERT_EQ(got.state == LocalProgress::State::hit, expected.state == Progress::State::hit)
          << "seed " << seed << " ray " << i;
      if (got.state != LocalProgress::State::hit) {
        ++misses;
        continue;
      }
      ++hits;
      ASSERT_EQ(got.hit.t, expected.hit.t) << "seed " << seed << " ray " << i;
      ASSERT_EQ(idOf(*got.model, got.hit), idOf(scene.model, expected.hit))
          << "seed " << seed << " ray " << i;
      ASSERT_EQ(got.voxel, expected.voxel) << "seed " << seed << " ray " << i;
      ASSERT_EQ(got.step, expected.step) << "seed " << seed << " ray " << i;
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(misses, 100);
  EXPECT_GT(fetched, hits + misses);
}

// Rays come in neighbourhoods, and each is told what stopped the one before.
TEST(LocalTrace, ShadowsAreThoseOfTheVoxels) {
  int dark = 0, filtered = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const CutScene scene(seed);
    SeededRandom random(seed + 1000);
    Task task(scene, random, 0.4);
    ShadowRay before;
    for (int i = 0; i < 25; ++i) {
      ShadowRay shadow;
      shadow.ray = randomRay(random);
      if (i > 0 && random.chance(0.6)) {
        shadow.ray = before.ray;
        shadow.ray.origin = shadow.ray.origin + random.point(-0.2, 0.2);
      }
      shadow.distance = random.chance(0.3) ? kInfinity : random.real(0, 10);
      ShadowRay whole = shadow;
      shadow.occluder = before.occluder;
      shadow.occluderGround = before.occluderGround;
      TraceCounts counts;
      const Progress expected =
          followShadow(scene.tree, scene.model, scene, whole, 0, scene.settings, counts);
      std::uint32_t unit = 0;
      const LocalProgress got = followFetching(scene, task, random, [&] {
        return followLocally(scene.tree, task, shadow, unit, scene.settings, counts);
      });
      before = shadow;
      ASSERT_EQ(got.state == LocalProgress::State::hit, expected.state == Progress::State::hit)
          << "seed " << seed << " ray " << i;
      if (got.state == LocalProgress::State::hit) {
        ++dark;
        continue;
      }
      filtered += shadow.through != kWhite;
      ASSERT_EQ(encode(shadow.through), encode(whole.through)) << "seed " << seed << " ray " << i;
    }
  }
  EXPECT_GT(dark, 100);
  EXPECT_GT(filtered, 20);
}

// A shadow ray that misses a cell may travel instead: the voxels take it from where it is.
TEST(LocalTrace, AShadowRayMayBeHandedOverWhereItMissedACell) {
  int handedOver = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const CutScene scene(seed);
    SeededRandom random(seed + 2000);
    Task task(scene, random, 0.5);
    for (std::uint32_t c = 0; c < cellCount(scene.tree); ++c)
      if (random.chance(0.5)) task.fetch(CellId{c});
    for (int i = 0; i < 25; ++i) {
      ShadowRay shadow;
      shadow.ray = randomRay(random);
      shadow.distance = kInfinity;
      ShadowRay whole = shadow;
      TraceCounts counts;
      const Progress expected =
          followShadow(scene.tree, scene.model, scene, whole, 0, scene.settings, counts);
      std::uint32_t unit = 0;
      const LocalProgress local = followLocally(scene.tree, task, shadow, unit, scene.settings, counts);
      bool isDark = local.state == LocalProgress::State::hit;
      if (local.state == LocalProgress::State::missing) {
        ++handedOver;
        shadow = decode<ShadowRay>(encode(shadow)).value();
        isDark =
            followShadow(scene.tree, scene.model, scene, shadow, local.step, scene.settings, counts).state ==
            Progress::State::hit;
      }
      ASSERT_EQ(isDark, expected.state == Progress::State::hit) << "seed " << seed << " ray " << i;
      if (!isDark) {
        ASSERT_EQ(encode(shadow.through), encode(whole.through)) << "seed " << seed << " ray " << i;
      }
    }
  }
  EXPECT_GT(handedOver, 100);
}

TEST(LocalTrace, WithAllVoxelsOfOnesOwnTheVisitsAreTheSame) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const CutScene scene(seed);
    SeededRandom random(seed + 3000);
    Task task(scene, random, 1);
    TraceCounts local, whole;
    for (int i = 0; i < 50; ++i) {
      const Ray ray = randomRay(random);
      std::uint32_t unit = 0;
      followLocally(scene.tree, task, ray, unit, local);
      followRay(scene.tree, scene.model, scene, ray, 0, whole);
    }
    EXPECT_EQ(local.visits, whole.visits);
    EXPECT_EQ(local.hits, whole.hits);
  }
}

}  // namespace
}  // namespace rayshade
