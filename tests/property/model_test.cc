// nearestHit() and occlusion() find what a test of every object in turn finds: random scenes of all shapes, in nodes, in
// definitions used several times and nested, and as operands of CSG.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/bundle_hit.h"

#include <gtest/gtest.h>

#include "rayshade/intersect/csg.h"
#include "rayshade/intersect/ray_hit.h"
#include "tests/support/seeded_random.h"
#include "tests/support/text_arguments.h"

namespace rayshade {
namespace {

// All examples of the shapes, but those that read files.
std::vector<AnyShape> exampleShapes() {
  std::vector<AnyShape> shapes;
  AllShapes::forEach([&]<class S>() {
    if (BeginsWithFile<S>) return;
    for (const std::string_view example : S::examples) {
      TextArguments arguments(example);
      if (const std::optional<S> shape = S::parse(arguments)) shapes.push_back(*shape);
    }
  });
  return shapes;
}

// Builds a scene; item numbers count up, so that nodes and definitions come before what uses them.
class SceneMaker {
 public:
  SceneMaker(Random& random, Model& model) : random_(random), store_(model.store()) {
    Surface glass;
    glass.transparency = 0.5;
    store_.surface(SurfaceId{0}, Surface{});
    if (random.oneIn(2)) store_.surface(SurfaceId{1}, glass);
    for (int i = random.below(3); i >= 0; --i) {
      const DefinitionId definition{next_++};
      for (int k = random.below(8); k >= 0; --k) member(definition);
      definitions_.push_back(definition);
    }
    for (int i = 5 + random.below(60); i > 0; --i) member(kWorld);
    model.prepare(Exposure{});
  }

 private:
  void member(DefinitionId container) {
    SceneObject object;
    object.container = container;
    const std::uint32_t kind = random_.below(10);
    if (kind == 0 && !definitions_.empty()) {
      object.body = Instance{random_.pick(definitions_)};
    } else if (kind == 1) {
      const DefinitionId operands{next_++};
      solid(operands);
      solid(operands);
      object.body = Csg{CsgOperation{static_cast<std::uint8_t>(random_.below(3))}, operands};
    } else {
      object.body = shape();
    }
    place(object);
  }
  void solid(DefinitionId container) {
    SceneObject object;
    object.container = container;
    object.body = Sphere{random_.point(-1, 1), random_.real(0.5, 2)};
    place(object);
  }
  // Spheres and triangles most often; on a lattice, so that things coincide.
  AnyShape shape() {
    static const std::vector<AnyShape> examples = exampleShapes();
    const Vec3 at{double(random_.below(9)) - 4, double(random_.below(9)) - 4, double(random_.below(9)) - 4};
    if (random_.oneIn(3)) return Sphere{at, 0.25 * (1 + random_.below(6))};
    if (random_.oneIn(3))
      return Triangle{{at, at + Vec3{2, 0, 0}, at + Vec3{0, 2, double(random_.below(2))}}};
    return random_.pick(examples);
  }
  void place(SceneObject& object) {
    object.id = ObjectId{next_++};
    object.surface = SurfaceId{random_.below(2u)};
    if (random_.oneIn(2)) {
      SceneNode node;
      node.transforms.append(rotation(random_.point(-1, 1), random_.real(0, 360)));
      if (random_.oneIn(2)) node.transforms.append(*scaling(random_.point(0.3, 2)));
      node.transforms.append(translation(random_.point(-4, 4)));
      object.node = NodeId{next_++};
      store_.node(object.node, node);
    }
    store_.object(object);
  }

  Random& random_;
  SceneStore& store_;
  std::uint32_t next_ = 1;
  std::vector<DefinitionId> definitions_;
};

// The first t > tMin, without accelerator, in world units.
double bruteForce(const Model& model, ObjectIndex index, const LocalRay& outer, double tMin) {
  const SceneStore& store = model.store();
  const PlacedObject& object = store.object(index);
  const LocalRay ray = intoNode(store, object.node, outer, {});
  if (object.kind == kInstanceKind) {
    double nearest = kNoHit;
    for (ObjectIndex member : store.objectsOf(store.instance(object).definition))
      nearest = std::min(nearest, bruteForce(model, member, ray, tMin));
    return nearest;
  }
  if (object.kind == kCsgKind) return firstCrossing(model, model.solid(object.body), ray, {}, tMin).t;
  return withShape(store, object, [&](const auto& shape) {
    double t = shape.intersect(ray, tMin * ray.scale * (1 - 0x1p-50));
    while (t < kNoHit && t / ray.scale <= tMin) t = shape.intersect(ray, t);
    return t / ray.scale;
  });
}

// Transparent as far as occlusion() has to tell: what may be must be looked at when it is hit.
bool mayBeTransparent(const Model& model, ObjectIndex index) {
  const PlacedObject& object = model.store().object(index);
  if (!model.store().anyTransparent()) return false;
  if (object.kind == kInstanceKind || object.kind == kCsgKind) return true;
  return model.store().surfaceOrDefault(object.surface).transparency >= kNegligible;
}

TEST(Model, VisitAndObstructionFindWhatATestOfEveryObjectFinds) {
  int hits = 0, ties = 0, dark = 0;
  for (std::uint64_t scene = 0; scene < 150; ++scene) {
    SeededRandom random(scene);
    Model model;
    SceneMaker(random, model);
    const auto objects = model.store().objectsOf(kWorld);
    const Region region = model.regionOf({objects.begin(), objects.end()});
    for (int i = 0; i < 60; ++i) {
      Ray ray;
      ray.origin = random.point(-8, 8);
      ray.direction = normalize(random.point(-3, 3) - ray.origin);
      if (random.oneIn(4)) {  // along an axis, through points of the lattice
        ray.origin = {double(random.below(9)) - 4, double(random.below(9)) - 4, -9};
        ray.direction = {0, 0, 1};
      }
      const double tMin = random.oneIn(3) ? random.real(0, 6) : 0;
      const double tExit = random.oneIn(3) ? tMin + random.real(0, 6) : kInfinity;
      Hit nearest;
      bool opaque = false, transparent = false;
      for (ObjectIndex object : objects) {
        const double t = bruteForce(model, object, {ray.origin, ray.direction, 1}, tMin);
        if (!(t < tExit)) continue;
        (mayBeTransparent(model, object) ? transparent : opaque) = true;
        const bool tie = t == nearest.t;
        ties += tie;
        if (t < nearest.t || (tie && precedence(model.store().object(object)) <
                                         precedence(model.store().object(nearest.object))))
          nearest = {t, object};
      }
      const Hit hit = nearestHit(model, region, ray, tMin, tExit);
      ASSERT_EQ(hit.t, nearest.t) << "scene " << scene << " ray " << i;
      ASSERT_EQ(hit.object, nearest.object) << "scene " << scene << " ray " << i;
      hits += hit.found();
      dark += opaque;
      Segment segment(ray, tMin, tExit);
      Occlusion met;
      occlusions(model, region, std::span(&segment, 1), std::span(&met, 1));
      ASSERT_EQ(met.opaque, opaque) << "scene " << scene << " ray " << i;
      if (!opaque) {
        ASSERT_EQ(met.transparent, transparent);
      }
    }
  }
  EXPECT_GT(hits, 2000);
  EXPECT_GT(ties, 30);
  EXPECT_GT(dark, 1000);
}

}  // namespace
}  // namespace rayshade
