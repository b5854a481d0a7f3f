// What a task finds with what is local to it is what one process finds that has everything, bit for bit, wherever a ray is
// interrupted: cells are fetched and forgotten, rays are handed over from task to task.
//
// guarded: juggles tasks
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/trace/local_space.h"

#include <gtest/gtest.h>

#include <memory>

#include "pvm/messages/rays.h"
#include "pvm/trace/task_space.h"
#include "rayshade/language/parser.h"
#include "rayshade/scene/extract.h"
#include "rayshade/space/walk.h"
#include "rayshade/trace/scene.h"
#include "rayshade/trace/trace_shadows.h"
#include "tests/support/random_scene.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

constexpr Exposure kExposure{0.25, 0.75, 0};

// A random scene in one process, and how it is cut into voxels and cells.
struct CutScene {
  explicit CutScene(std::uint64_t seed) {
    whole.settings = parseSceneText(randomScene(seed), "text", {}, whole.model.store()).settings;
    whole.prepare(kExposure);
    Bounds world;
    DensityGrid density;
    for (ObjectIndex object : model().store().objectsOf(kWorld)) {
      const Bounds bounds = model().boundsOf(object);
      if (bounds.finite()) world = join(world, bounds);
      density.add(bounds);
    }
    tree = buildBinTree(world, {static_cast<std::uint32_t>(1 + seed % 6), 40}, density);
    inVoxel.resize(voxelCount(tree));
    inCell.resize(cellCount(tree));
    boxes.resize(cellCount(tree));
    for (ObjectIndex object : model().store().objectsOf(kWorld)) {
      const Bounds bounds = model().boundsOf(object);
      std::vector<VoxelId> voxels;
      voxelsTouching(tree, bounds, voxels);
      for (VoxelId v : voxels) inVoxel[static_cast<std::size_t>(v)].push_back(object);
      std::vector<CellId> cells;
      cellsTouching(tree, bounds, cells);
      for (CellId c : cells) {
        const auto at = static_cast<std::size_t>(c);
        inCell[at].push_back(object);
        boxes[at] = join(boxes[at], boundsInCell(bounds, tree, c));
      }
    }
  }
  const Model& model() const { return whole.model; }

  Scene whole;
  BinTree tree;
  std::vector<std::vector<ObjectIndex>> inVoxel, inCell;
  std::vector<Bounds> boxes;
};

// Items as another task of this machine gets them, which has the pixels of their images already.
std::vector<Item> overTheWire(const std::vector<Item>& items) {
  std::vector<Item> come = decode<std::vector<Item>>(encode(items)).value();
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto* sent = std::get_if<NodeItem>(&items[i]);
    if (sent == nullptr) continue;
    for (std::size_t t = 0; t < sent->node.textures.size(); ++t)
      if (const auto* image = std::get_if<ImageTexture>(&sent->node.textures[t].texture))
        std::get<ImageTexture>(std::get<NodeItem>(come[i]).node.textures[t].texture).image = image->image;
  }
  return come;
}

// Holds some voxels, and those cells of others that were fetched, each a model of its own that came over the wire.
class Task final : public LocalSpace {
 public:
  Task(const CutScene& scene, std::vector<bool> held, bool fetches)
      : scene_(scene), map_(scene.tree, scene.boxes, held, fetches), cells_(cellCount(scene.tree)) {
    for (std::size_t v = 0; v < held.size(); ++v)
      if (held[v]) regions_.push_back(std::make_unique<Region>(scene.model().regionOf(scene.inVoxel[v])));
    for (const auto& region : regions_) whole_.push_back({&scene.model(), region.get()});
  }
  static Task random(const CutScene& scene, Random& numbers, double share, bool fetches) {
    std::vector<bool> held(voxelCount(scene.tree));
    for (std::size_t v = 0; v < held.size(); ++v) held[v] = numbers.real(0, 1) < share;
    return Task(scene, std::move(held), fetches);
  }

  const BinTree& tree() const override { return scene_.tree; }
  const BlockMap& blocks() const override { return map_; }
  std::span<const RegionRef> whole(std::size_t, RayKind) override { return whole_; }
  RegionRef region(std::uint32_t block, std::size_t rays, RayKind) override {
    EXPECT_GT(rays, 0u);
    const auto& cell = cells_[static_cast<std::size_t>(map_.blocks()[block].cell)];
    return cell ? RegionRef{&cell->model, &cell->region} : RegionRef{};
  }
  bool isLocal(std::uint32_t block) const override { return has(map_.blocks()[block].cell); }

  bool has(CellId cell) const { return cells_[static_cast<std::size_t>(cell)] != nullptr; }
  void fetch(CellId cell) {
    Extract extract(scene_.model().store());
    for (ObjectIndex object : scene_.inCell[static_cast<std::size_t>(cell)]) extract.add(object);
    auto fetched = std::make_unique<Fetched>();
    fetched->model.take(overTheWire(extract.items));
    fetched->model.prepare(kExposure);
    const auto objects = fetched->model.store().objectsOf(kWorld);
    fetched->region = fetched->model.regionOf({objects.begin(), objects.end()});
    EXPECT_EQ(fetched->model.leftOut(), 0u);
    cells_[static_cast<std::size_t>(cell)] = std::move(fetched);
  }
  void forget() {
    for (auto& cell : cells_) cell.reset();
  }
  // What it says of where a ray goes on is true.
  void check(const NextBlock& next, const LocalRay& ray, double begin) const {
    EXPECT_FALSE(map_.held(next.voxel));
    EXPECT_EQ(voxelOfCell(scene_.tree, next.cell), next.voxel);
    const auto step = stepAt<VoxelId>(scene_.tree, ray.origin, ray.direction, next.step);
    ASSERT_TRUE(step);
    EXPECT_EQ(step->where, next.voxel);
    EXPECT_LE(step->tEnter, next.tEnter);
    EXPECT_GE(step->tExit, begin);
    EXPECT_FALSE(map_.fetches() && has(next.cell));
  }

 private:
  struct Fetched {
    Model model;
    Region region;
  };
  const CutScene& scene_;
  BlockMap map_;
  std::vector<std::unique_ptr<Region>> regions_;  // of the voxels that are held
  std::vector<RegionRef> whole_;
  std::vector<std::unique_ptr<Fetched>> cells_;
};

std::vector<Ray> randomBundle(Random& numbers, std::size_t count) {
  std::vector<Ray> rays(count);
  const Vec3 eye = numbers.point(-7, 7);
  const double spread = numbers.real(0, 1) < 0.5 ? 0.1 : 3;
  for (Ray& ray : rays) {
    ray.origin = eye;
    ray.direction = normalize(spread * numbers.point(-1, 1) - eye);
    if (numbers.real(0, 1) < 0.05) ray.direction = {0, 0, -1};
    ray.moment = {numbers.real(kExposure.opens, kExposure.closes), 0};
  }
  return rays;
}

struct Traced {
  Hit hit;
  std::optional<ObjectId> id;  // of the object
  bool resolved = false;
  NextBlock next{};
};
std::vector<Traced> traceBundle(LocalSpace& space, const std::vector<Ray>& rays,
                                const std::vector<double>& begin) {
  FoundHits found;
  TraceCounts counts;
  traceRays(space, rays, begin, found, counts);
  std::vector<Traced> traced(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    traced[i].hit = found.hits[i];
    if (found.hits[i].found()) traced[i].id = found.models[i]->store().object(found.hits[i].object).id;
    traced[i].resolved = found.resolved(i);
    if (!traced[i].resolved) traced[i].next = found.next[i];
  }
  return traced;
}

void expectSame(const Traced& got, const Traced& expected) {
  ASSERT_EQ(got.hit.t, expected.hit.t);
  ASSERT_EQ(got.id, expected.id);
}

TEST(LocalSpace, WhatIsResolvedIsRight) {
  std::size_t hits = 0, open = 0, misses = 0;
  for (std::uint64_t seed = 1; seed <= seedCount(60); ++seed) {
    CutScene scene(seed);
    SeededRandom numbers(seed + 1000);
    Task task = Task::random(scene, numbers, std::array{0.0, 0.5, 0.9, 1.0}[seed % 4], seed % 3 != 0);
    for (std::uint32_t c = 0; seed % 3 != 0 && c < cellCount(scene.tree); ++c)
      if (numbers.real(0, 1) < 0.6) task.fetch(CellId{c});
    for (std::size_t round = 0; round < 12; ++round) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " round " << round);
      const std::vector<Ray> rays = randomBundle(numbers, 1 + (seed + 5 * round) % kBundleSize);
      const std::vector<Traced> expected = traceBundle(scene.whole, rays, {}),
                                got = traceBundle(task, rays, {});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(expected[i].resolved);
        if (got[i].resolved) {
          expectSame(got[i], expected[i]);
          ++(expected[i].hit.found() ? hits : misses);
        } else {
          ASSERT_GE(got[i].hit.t, expected[i].hit.t);
          task.check(got[i].next, Segment(rays[i]).ray, 0);
          ++open;
        }
      }
    }
  }
  for (std::size_t number : {hits, open, misses}) EXPECT_GT(number, 8 * seedCount(60));
}

// Cells are fetched as they are missed; now and then all others are forgotten: what was looked at is not asked for again.
TEST(LocalSpace, FetchingWhatIsMissingFindsTheSame) {
  std::size_t fetched = 0, hits = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CutScene scene(seed);
    SeededRandom numbers(seed);
    Task task = Task::random(scene, numbers, 0.4, true);
    for (int n = 0; n < 25; ++n) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " ray " << n);
      const std::vector<Ray> ray = randomBundle(numbers, 1);
      std::vector<double> begin{0};
      std::vector<Traced> got = traceBundle(task, ray, begin);
      for (std::uint32_t rounds = 0; !got[0].resolved; got = traceBundle(task, ray, begin)) {
        ASSERT_LE(++rounds, cellCount(scene.tree)) << "it goes round in circles";
        task.check(got[0].next, Segment(ray[0]).ray, begin[0]);
        if (numbers.real(0, 1) < 0.2) task.forget();
        task.fetch(got[0].next.cell);
        begin[0] = got[0].next.tEnter;
        ++fetched;
      }
      expectSame(got[0], traceBundle(scene.whole, ray, {})[0]);
      hits += got[0].hit.found();
    }
  }
  EXPECT_GT(fetched, 300u);
  EXPECT_GT(hits, 200u);
}

// A task without voxels, whose cells are joined now and then.
TEST(LocalSpace, CellsThatWereJoinedAreMetAsBefore) {
  std::size_t resolved = 0, single = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    CutScene scene(seed);
    SeededRandom numbers(seed + 3000);
    EpochSettings at;
    at.tree = scene.tree;
    at.exposure = kExposure;
    at.cellBytes.assign(cellCount(scene.tree), 1);
    ObjectCache cache;
    cache.begin(1 << 26);
    TaskSpace space(at, nullptr, cache);
    space.begin(scene.boxes, TaskId{1});
    for (std::uint32_t c = 0; c < cellCount(scene.tree); ++c) {
      if (numbers.real(0, 1) < 0.2) continue;
      Extract extract(scene.model().store());
      for (ObjectIndex object : scene.inCell[c]) extract.add(object);
      cache.insert(CellId{c}, overTheWire(extract.items), kExposure, 1);
      if (numbers.real(0, 1) < 0.7) continue;
      cache.find(CellId{c}, 1 << 26);
      space.settle();
      ASSERT_TRUE(cache.isJoined(CellId{c}));
      ASSERT_EQ(cache.joinedModel().leftOut(), 0u);
    }
    single += !space.blocks().inOrder().empty();
    for (std::size_t round = 0; round < 6; ++round) {
      const std::vector<Ray> rays = randomBundle(numbers, 1 + (seed + 5 * round) % kBundleSize);
      const std::vector<Traced> expected = traceBundle(scene.whole, rays, {}),
                                got = traceBundle(space, rays, {});
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!got[i].resolved) continue;
        expectSame(got[i], expected[i]);
        ++resolved;
      }
    }
  }
  EXPECT_GT(resolved, 1000u);
  EXPECT_GT(single, 20u);
}

// Every voxel is held by one of several tasks, which hand rays on by their position on the walk.
std::vector<Task> sharedOut(const CutScene& scene, std::size_t tasks) {
  std::vector<Task> all;
  for (std::size_t t = 0; t < tasks; ++t) {
    std::vector<bool> held(voxelCount(scene.tree));
    for (std::size_t v = 0; v < held.size(); ++v) held[v] = v % tasks == t;
    all.emplace_back(scene, std::move(held), t % 2 == 1);
  }
  return all;
}

TEST(LocalSpace, HandingRaysOnFindsTheSame) {
  std::size_t handedOn = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CutScene scene(seed);
    SeededRandom numbers(seed + 2000);
    std::vector<Task> tasks = sharedOut(scene, 2 + seed % 3);
    for (int n = 0; n < 25; ++n) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " ray " << n);
      const std::vector<Ray> ray = randomBundle(numbers, 1);
      std::vector<Traced> got = traceBundle(tasks[0], ray, {});
      for (std::uint32_t rounds = 0; !got[0].resolved; ++handedOn) {
        ASSERT_LE(++rounds, voxelCount(scene.tree));
        const NextBlock next = got[0].next;
        const double begin = walkedTo(scene.tree, ray[0].origin, ray[0].direction, next.step);
        got = traceBundle(tasks[static_cast<std::size_t>(next.voxel) % tasks.size()], ray, {begin});
      }
      expectSame(got[0], traceBundle(scene.whole, ray, {})[0]);
    }
  }
  EXPECT_GT(handedOn, 300u);
}

// ---- shadow rays

struct Shadow {
  Color through;
  std::optional<OpenShadow> open;
};
Shadow traceShadow(LocalSpace& space, const ShadowRay& shadow, double begin, const SceneSettings& settings) {
  Segment segment(shadow.ray, shadow.last, shadow.distance);
  Color through = shadow.through;
  std::vector<OpenShadow> open;
  TraceCounts counts;
  traceShadows(space, std::span(&segment, 1), std::span(&begin, 1), settings, std::span(&through, 1), open,
               counts, [&](std::size_t) { return shadow; });
  if (open.empty()) return {through, std::nullopt};
  return {through, open[0]};
}

ShadowRay randomShadow(Random& numbers) {
  ShadowRay shadow;
  shadow.ray = randomBundle(numbers, 1)[0];
  shadow.distance = numbers.real(0, 1) < 0.3 ? kInfinity : numbers.real(0, 12);
  return shadow;
}

TEST(LocalSpace, ShadowsAreTheSameHoweverTheyAreTraced) {
  std::size_t dark = 0, filtered = 0, fetched = 0, handedOn = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CutScene scene(seed);
    const SceneSettings& settings = scene.whole.settings;
    SeededRandom numbers(seed + 3000);
    Task fetching = Task::random(scene, numbers, 0.4, true);
    std::vector<Task> tasks = sharedOut(scene, 2 + seed % 3);
    for (int n = 0; n < 25; ++n) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " ray " << n);
      const ShadowRay start = randomShadow(numbers);
      const Shadow expected = traceShadow(scene.whole, start, 0, settings);
      ASSERT_FALSE(expected.open);
      dark += expected.through == kBlack;
      filtered += expected.through != kBlack && expected.through != kWhite;

      Shadow got = traceShadow(fetching, start, 0, settings);
      for (std::uint32_t rounds = 0; got.open; ++fetched) {
        ASSERT_LE(++rounds, cellCount(scene.tree)) << "it goes round in circles";
        const OpenShadow open = *got.open;
        fetching.check(*open.next, Segment(start.ray).ray, 0);
        if (numbers.real(0, 1) < 0.2) fetching.forget();
        fetching.fetch(open.next->cell);
        got = traceShadow(fetching, open.shadow, open.next->tEnter, settings);
      }
      ASSERT_EQ(encode(got.through), encode(expected.through));

      got = traceShadow(tasks[0], start, 0, settings);
      for (std::uint32_t rounds = 0; got.open; ++handedOn) {
        ASSERT_LE(++rounds, voxelCount(scene.tree));
        const NextBlock next = *got.open->next;
        const ShadowHead head{TaskId{1}, 0, start.ray.moment, start.ray.sample, start.ray.key};
        const ShadowRay shadow = shadowOf(head, travelOf(got.open->shadow, 0, next.step));
        got = traceShadow(tasks[static_cast<std::size_t>(next.voxel) % tasks.size()], shadow,
                          walkedTo(scene.tree, start.ray.origin, start.ray.direction, next.step), settings);
      }
      ASSERT_EQ(encode(got.through), encode(expected.through));
    }
  }
  EXPECT_GT(dark, 300u);
  EXPECT_GT(filtered, 20u);
  EXPECT_GT(fetched, 200u);
  EXPECT_GT(handedOn, 200u);
}

TEST(LocalSpace, ABoxIsMetFromWhereItBeginsToWhereItEnds) {
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
