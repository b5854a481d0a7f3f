// The stream of placed objects says of each what a store that holds the whole scene would say.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/object_stream.h"

#include <gtest/gtest.h>

#include <set>

#include <algorithm>

#include "rayshade/intersect/model.h"
#include "rayshade/language/parser.h"
#include "tests/support/random_scene.h"

namespace rayshade {
namespace {

struct Placed {
  SceneObject object;
  Bounds bounds;
  std::vector<NodeItem> nodes;
};

// Several sinks in the place of one.
class Tee final : public SceneSink {
 public:
  Tee(SceneSink& one, SceneSink& other) : sinks_{&one, &other} {}
  void surface(SurfaceId id, const Surface& s) override {
    for (SceneSink* sink : sinks_) sink->surface(id, s);
  }
  void node(NodeId id, SceneNode f) override {
    for (SceneSink* sink : sinks_) sink->node(id, f);
  }
  void object(SceneObject o) override {
    for (SceneSink* sink : sinks_) sink->object(o);
  }
  void endOfStatement() override {
    for (SceneSink* sink : sinks_) sink->endOfStatement();
  }

 private:
  SceneSink* sinks_[2];
};

// A scene read once, into a stream and into a model.
struct Both {
  explicit Both(const std::string& text, const Exposure& exposure = {})
      : stream(exposure, [this](const SceneObject& object, const Bounds& bounds,
                                std::span<const NodeItem* const> nodes, const ObjectStream::Brought&) {
          Placed& one = placed.emplace_back(Placed{object, bounds, {}});
          for (const NodeItem* node : nodes) one.nodes.push_back(*node);
        }) {
    Tee tee(stream, model.store());
    parseSceneText(text, "text", {}, tee);
    model.prepare(exposure);
  }

  std::vector<Placed> placed;
  ObjectStream stream;
  Model model;
};

// What `object` needs of its definition, all the way down, but for what is in `added`.
void addDefinition(ObjectStream& stream, const SceneObject& object, std::set<DefinitionId>& added,
                   std::vector<Item>& items) {
  DefinitionId used = kWorld;
  if (const Instance* instance = std::get_if<Instance>(&object.body)) used = instance->definition;
  if (const Csg* csg = std::get_if<Csg>(&object.body)) used = csg->operands;
  if (used == kWorld || !added.insert(used).second) return;
  stream.readDefinition(used, [&](const Item& item) {
    if (const SceneObject* inside = std::get_if<SceneObject>(&item))
      addDefinition(stream, *inside, added, items);
    items.push_back(item);
  });
}

void expectSame(Both& both, const std::string& name) {
  const auto objects = both.model.store().objectsOf(kWorld);
  ASSERT_EQ(both.placed.size(), objects.size()) << name;
  EXPECT_EQ(both.stream.objects(), objects.size()) << name;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Placed& one = both.placed[i];
    ASSERT_EQ(one.object.id, both.model.store().object(objects[i]).id) << name;
    ASSERT_EQ(one.bounds, both.model.boundsOf(objects[i])) << name << " object " << i;
  }
}

TEST(ObjectStream, BoundsAreThoseOfAStoreWithTheWholeScene) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Both both(randomScene(seed), {0.25, 0.75, 0});
    expectSame(both, "seed " + std::to_string(seed));
  }
}

TEST(ObjectStream, AnObjectWithItsFramesAndDefinitionsStandsOnItsOwn) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Exposure exposure{0.25, 0.75, 0};
    Both both(randomScene(seed), exposure);
    for (const Placed& one : both.placed) {
      Model model;
      std::vector<Item> items;
      std::uint32_t last = 0;
      for (const NodeItem& node : one.nodes) {
        EXPECT_GT(number(node.id), last) << "nodes come in the order of their numbers";
        last = number(node.id);
        items.emplace_back(node);
      }
      std::set<DefinitionId> added;
      addDefinition(both.stream, one.object, added, items);
      items.emplace_back(one.object);
      for (const Item& item : std::vector<Item>(items)) {
        const SceneObject* object = std::get_if<SceneObject>(&item);
        const NodeItem* node = std::get_if<NodeItem>(&item);
        for (SurfaceId id : {object ? object->surface : kNoSurface, node ? node->node.surface : kNoSurface})
          if (const auto surface = both.stream.findSurface(id)) items.emplace_back(SurfaceItem{id, *surface});
      }
      model.take(std::move(items));
      model.prepare(exposure);
      EXPECT_EQ(model.leftOut(), 0u) << "seed " << seed;
      ASSERT_EQ(model.store().objectsOf(kWorld).size(), 1u) << "seed " << seed;
      ASSERT_EQ(model.boundsOf(model.store().objectsOf(kWorld)[0]), one.bounds) << "seed " << seed;
    }
  }
}

// The transforms of a list stand behind its end, and so do those of the list around it.
TEST(ObjectStream, TransformsBehindAnAggregateReachItsMembers) {
  Both both(
      "list\n sphere 1 0 0 0\n list\n  sphere 1 0 0 0 translate 1 0 0\n  box 0 0 0 1 1 1\n end translate 0 "
      "10 0\n"
      "end scale 2 2 2\nsphere 1 5 5 5\n");
  expectSame(both, "nested lists");
  ASSERT_EQ(both.placed.size(), 4u);
  EXPECT_EQ(both.placed[0].bounds, padded({{-2, -2, -2}, {2, 2, 2}}));
  EXPECT_EQ(both.placed[1].bounds, padded({{0, 18, -2}, {4, 22, 2}}));
  EXPECT_EQ(both.placed[2].bounds, padded({{0, 20, 0}, {2, 22, 2}}));
  EXPECT_EQ(both.placed[3].bounds, padded({{4, 4, 4}, {6, 6, 6}}));
  EXPECT_EQ(both.placed[1].nodes.size(), 3u);
  EXPECT_EQ(both.placed[2].nodes.size(), 2u);
  EXPECT_TRUE(both.placed[3].nodes.empty());
}

TEST(ObjectStream, ADefinitionIsReadBackAsOftenAsItIsUsed) {
  Both both(
      "name ball list sphere 1 0 0 0 sphere 1 0 0 3 end scale 2 2 2\n"
      "name pair list object ball object ball translate 9 0 0 end\n"
      "object pair\nobject ball translate 1 1 1\n");
  expectSame(both, "definitions");
  ASSERT_EQ(both.placed.size(), 2u);
  for (int again = 0; again < 3; ++again) {
    std::vector<Item> pair, ball;
    std::set<DefinitionId> added;
    addDefinition(both.stream, both.placed[0].object, added, pair);
    added.clear();
    addDefinition(both.stream, both.placed[1].object, added, ball);
    auto objects = [](const std::vector<Item>& items) {
      return std::count_if(items.begin(), items.end(),
                           [](const Item& i) { return std::holds_alternative<SceneObject>(i); });
    };
    EXPECT_EQ(objects(ball), 2);
    EXPECT_EQ(objects(pair), 2 + 2);
  }
}

TEST(ObjectStream, OfADefinitionThatIsNotThereNothingIsRead) {
  Both both("sphere 1 0 0 0\n");
  int items = 0;
  both.stream.readDefinition(DefinitionId{99}, [&](const Item&) { ++items; });
  both.stream.readDefinition(kWorld, [&](const Item&) { ++items; });
  EXPECT_EQ(items, 0) << "the world is not kept";
}

// More than fits into memory is spooled to disk, and comes back the same; of the nodes of the statement an object gets
// its own.
TEST(ObjectStream, AStatementMayBeLargerThanMemory) {
  std::string text = "list\n";
  for (int i = 0; i < 9000; ++i)
    text += "sphere 1 " + std::to_string(i) + " 0 0 rotate 0 0 1 " + std::to_string(i % 360) + "\n";
  Both both(text + "end translate 0 0 7\n");
  expectSame(both, "large list");
  for (const Placed& one : both.placed) ASSERT_EQ(one.nodes.size(), 2u);
}

TEST(ObjectStream, SurfacesAreFoundByTheirNumbers) {
  Both both(
      "surface red diffuse 1 0 0\nsurface blue diffuse 0 0 1\nsphere blue 1 0 0 0\nsphere red 1 0 0 0\n");
  ASSERT_EQ(both.placed.size(), 2u);
  EXPECT_EQ(both.stream.findSurface(both.placed[0].object.surface)->diffuse, (Color{0, 0, 1}));
  EXPECT_EQ(both.stream.findSurface(both.placed[1].object.surface)->diffuse, (Color{1, 0, 0}));
  EXPECT_EQ(both.stream.findSurface(SurfaceId{99}), std::nullopt);
}

}  // namespace
}  // namespace rayshade
