// guarded: reads text of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/parser.h"

#include <gtest/gtest.h>

#include <map>

#include "rayshade/language/surface_table.h"
#include "rayshade/language/viewing.h"

namespace rayshade {
namespace {

// Keeps everything, and checks the order that SceneSink promises.
struct Recording final : SceneSink {
  std::map<std::uint32_t, Surface> surfaces;
  std::map<std::uint32_t, SceneNode> nodes;
  std::vector<SceneObject> objects;
  int settledCount = 0;

  void surface(SurfaceId id, const Surface& surface) override {
    EXPECT_TRUE(surfaces.emplace(number(id), surface).second);
  }
  void node(NodeId id, SceneNode node) override {
    EXPECT_NE(id, kRootNode);
    if (node.surface != kNoSurface) {
      EXPECT_TRUE(surfaces.contains(number(node.surface)));
    }
    EXPECT_TRUE(nodes.emplace(number(id), std::move(node)).second);
  }
  void object(SceneObject object) override {
    EXPECT_EQ(number(object.id), objects.size());
    if (object.surface != kNoSurface) {
      EXPECT_TRUE(surfaces.contains(number(object.surface)));
    }
    objects.push_back(std::move(object));
  }
  void endOfStatement() override {
    ++settledCount;
    for (const SceneObject& o : objects)
      if (o.node != kRootNode) {
        EXPECT_TRUE(nodes.contains(number(o.node)));
      }
    for (const auto& [id, node] : nodes)
      if (node.parent != kRootNode) {
        EXPECT_TRUE(nodes.contains(number(node.parent)));
      }
  }

  double red(SurfaceId id) const { return id == kNoSurface ? -1 : surfaces.at(number(id)).diffuse.r; }
  const SceneNode& nodeOf(std::size_t object) const { return nodes.at(number(objects.at(object).node)); }
};

struct Scene {
  Recording items;
  SceneHead head;
  std::vector<std::string> warnings, printed;
  std::string errors;

  ParseOptions options() {
    ParseOptions options;
    options.warn = [this](const std::string& message) { warnings.push_back(message); };
    options.print = [this](const std::string& message) { printed.push_back(message); };
    return options;
  }
};

std::unique_ptr<Scene> parse(const std::string& text) {
  auto scene = std::make_unique<Scene>();
  try {
    scene->head = parseSceneText(text, "s.ray", scene->options(), scene->items);
  } catch (const SceneError& error) {
    scene->errors = error.what();
  }
  return scene;
}

std::unique_ptr<Scene> parseFile(const std::string& name, const std::string& arguments = "") {
  auto scene = std::make_unique<Scene>();
  ParseOptions options = scene->options();
  options.fileName = name;
  options.preprocessorArguments = arguments;
  try {
    scene->head = parseScene(options, scene->items);
  } catch (const SceneError& error) {
    scene->errors = error.what();
  }
  return scene;
}

std::unique_ptr<Scene> good(const std::string& text) {
  auto scene = parse(text);
  EXPECT_EQ(scene->errors, "") << text;
  return scene;
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

// The lines that messages name.
std::vector<int> linesOf(const std::string& messages) {
  std::vector<int> lines;
  for (std::size_t at = 0; (at = messages.find("s.ray:", at)) != std::string::npos; ++at)
    lines.push_back(std::stoi(messages.substr(at + 6)));
  return lines;
}

std::string errorOf(const std::string& text) { return firstLine(parse(text)->errors); }

// red 1, green 2, blue 3: told apart by the red channel of their diffuse colour.
const std::string kSurfaces =
    "surface red diffuse 1 0 0 surface green diffuse 2 0 0 surface blue diffuse 3 0 0\n";

// The numbers of the surfaces of all objects, by kSurfaces; -1: none.
std::vector<double> surfacesOf(const std::string& text) {
  const auto scene = good(kSurfaces + text);
  std::vector<double> reds;
  for (const SceneObject& o : scene->items.objects) reds.push_back(scene->items.red(o.surface));
  return reds;
}
using Reds = std::vector<double>;

// ---- surfaces

TEST(Parser, DefinesSurfaces) {
  const auto s = good(
      "surface a ambient .1 .2 .3 diffuse .4 .5 .6 specular .7 .8 .9 specpow 3 reflect .2 transp .3 body 0 "
      ".5 1 "
      "index 1.5 extinct .9 translu .25 1 2 3 4 noshadow\n"
      "surface b a reflective .5 transparent .1 translucency .5 0 0 0 1\n"
      "surface c\n"
      "sphere a 1 0 0 0 sphere b 1 0 0 0 sphere c 1 0 0 0 sphere cursurf 1 0 0 0 sphere diffuse 9 9 9 1 0 0 "
      "0");
  ASSERT_EQ(s->items.surfaces.size(), 5u);
  const Surface& a = s->items.surfaces.at(0);
  EXPECT_EQ(a.ambient, (Color{.1, .2, .3}));
  EXPECT_EQ(a.diffuse, (Color{.4, .5, .6}));
  EXPECT_EQ(a.specular, (Color{.7, .8, .9}));
  EXPECT_EQ(a.body, (Color{0, .5, 1}));
  EXPECT_EQ(a.translucent, (Color{1, 2, 3}));
  EXPECT_EQ(a.specularPower, 3);
  EXPECT_EQ(a.reflect, .2);
  EXPECT_EQ(a.transparency, .3);
  EXPECT_EQ(a.index, 1.5);
  EXPECT_EQ(a.extinct, .9);
  EXPECT_EQ(a.translucency, .25);
  EXPECT_EQ(a.translucentPower, 4);
  EXPECT_TRUE(a.noShadow);
  const Surface& b = s->items.surfaces.at(1);
  EXPECT_EQ(b.ambient, a.ambient);
  EXPECT_EQ(b.reflect, .5);
  EXPECT_EQ(b.transparency, .1);
  EXPECT_EQ(b.translucency, .5);
  EXPECT_EQ(encode(s->items.surfaces.at(2)), encode(Surface{}));
  EXPECT_EQ(encode(s->items.surfaces.at(3)), encode(defaultSurface()));
  EXPECT_EQ(s->items.surfaces.at(4).diffuse, (Color{9, 9, 9}));
}

TEST(Parser, GivesEqualSurfacesOneNumber) {
  const auto s =
      good(kSurfaces +
           "sphere red 1 0 0 0 sphere red 1 0 0 0 sphere diffuse 1 0 0 1 0 0 0 surface same diffuse 1 0 0 "
           "sphere same 1 0 0 0 applysurf red sphere 1 0 0 0");
  EXPECT_EQ(s->items.surfaces.size(), 1u);
  EXPECT_EQ(s->items.objects.size(), 5u);
}

// The memory of a parser does not grow with them: an old one that comes again is a new one.
TEST(Parser, ForgetsSurfacesInPlaceAfterThousandsOfOthers) {
  constexpr std::size_t kObjects = SurfaceTable::kRemembered + 1;
  std::string text = "surface named diffuse 1 0 0\nsphere named 1 0 0 0\n";
  for (std::size_t i = 0; i < kObjects; ++i) text += "sphere specpow " + std::to_string(i) + " 1 0 0 0\n";
  const auto s = good(text + "sphere specpow 0 1 0 0 0 sphere named 1 0 0 0");
  EXPECT_EQ(s->items.surfaces.size(), kObjects + 2);
  EXPECT_EQ(s->items.objects.back().surface, s->items.objects.front().surface);
}

TEST(Parser, WarnsWhenASurfaceIsDefinedAgainAndUsesTheNewOne) {
  const auto s = good("surface a diffuse 1 0 0\nsphere a 1 0 0 0\nsurface a diffuse 2 0 0\nsphere a 1 0 0 0");
  ASSERT_EQ(s->warnings.size(), 1u);
  EXPECT_EQ(firstLine(s->warnings[0]), "s.ray:3:9: warning: surface `a` is defined again");
  EXPECT_EQ(s->items.red(s->items.objects[0].surface), 1);
  EXPECT_EQ(s->items.red(s->items.objects[1].surface), 2);
}

TEST(Parser, CopiesASurfaceIntoItself) {
  const auto s = good("surface a diffuse 1 0 0 surface a a reflect .5 sphere a 1 0 0 0");
  EXPECT_EQ(s->items.surfaces.at(0).diffuse.r, 1);
  EXPECT_EQ(s->items.surfaces.at(0).reflect, .5);
}

TEST(Parser, RefusesTransparencyWithoutIndex) {
  EXPECT_EQ(errorOf("surface a transp .5 index 0"),
            "s.ray:1:11: error: a transparent surface needs an index of refraction above 0");
  EXPECT_EQ(errorOf("surface a index 0"), "");
}

// ---- which surface an object gets

TEST(Parser, BindsASurfaceOfItsOwnFirstThenApplysurf) {
  EXPECT_EQ(surfacesOf("sphere 1 0 0 0 sphere red 1 0 0 0 applysurf green sphere 1 0 0 0 sphere red 1 0 0 0"),
            (Reds{-1, 1, 2, 1}));
}

TEST(Parser, ChangesCursurf) {
  EXPECT_EQ(surfacesOf("applysurf green sphere cursurf diffuse 7 0 0 1 0 0 0 sphere cursurf 1 0 0 0"),
            (Reds{7, 2}));
  EXPECT_EQ(surfacesOf("sphere red diffuse 8 0 0 1 0 0 0"), (Reds{8}));
}

TEST(Parser, GivesEveryAggregateItsOwnApplysurf) {
  const auto s = good(kSurfaces +
                      "applysurf blue list sphere 1 0 0 0 applysurf green sphere 1 0 0 0 end sphere 1 0 0 0");
  EXPECT_EQ(s->items.red(s->items.objects[0].surface), -1);
  EXPECT_EQ(s->items.red(s->items.objects[1].surface), 2);
  EXPECT_EQ(s->items.red(s->items.nodeOf(0).surface), 3);  // the list's own, taken when it ends
  EXPECT_EQ(s->items.red(s->items.objects[2].surface), 3);
}

TEST(Parser, StartsCursurfAfreshInAnAggregate) {
  const auto s = good(kSurfaces + "applysurf blue list sphere cursurf 1 0 0 0 end sphere cursurf 1 0 0 0");
  EXPECT_EQ(s->items.red(s->items.objects[0].surface), 0.6);  // the default surface
  EXPECT_EQ(s->items.red(s->items.objects[1].surface), 3);
}

TEST(Parser, GivesInstancesTheirSurface) {
  EXPECT_EQ(surfacesOf("name n sphere 1 0 0 0 object n object green n object red diffuse 5 0 0 n "
                       "object diffuse 6 0 0 n applysurf blue object n object cursurf n"),
            (Reds{-1, -1, 2, 5, 6, 3, 3}));
}

TEST(Parser, TakesTheApplysurfOfTheDefinitionIntoANamedObject) {
  EXPECT_EQ(surfacesOf("applysurf red name n sphere 1 0 0 0 applysurf green object blue n"), (Reds{1, 3}));
  const auto s = good(kSurfaces + "applysurf red name n list sphere 1 0 0 0 end object blue n");
  EXPECT_EQ(s->items.red(s->items.nodeOf(0).surface), 1);
}

TEST(Parser, GivesCsgTheSurfaceInForceWhenItEnds) {
  EXPECT_EQ(surfacesOf("applysurf blue difference sphere 1 0 0 0 sphere red 1 0 0 0 end"), (Reds{-1, 1, 3}));
}

TEST(Parser, NeverGivesApplysurfToAHeightField) {
  EXPECT_EQ(
      surfacesOf("applysurf red heightfield tests/support/hills.hf heightfield green tests/support/hills.hf "
                 "heightfield diffuse 5 0 0 tests/support/hills.hf "
                 "heightfield green diffuse 6 0 0 tests/support/hills.hf heightfield cursurf "
                 "tests/support/hills.hf"),
      (Reds{-1, 2, 5, 6, 1}));
}

// ---- nodes, transforms, textures

TEST(Parser, GivesAPrimitiveAFrameOnlyWhenItNeedsOne) {
  const auto s =
      good("sphere 1 0 0 0 sphere 1 0 0 0 translate 1 2 3 sphere 1 0 0 0 texture checker diffuse 1 1 1");
  EXPECT_EQ(s->items.objects[0].node, kRootNode);
  EXPECT_EQ(s->items.nodeOf(1).transforms.steps.size(), 1u);
  EXPECT_TRUE(s->items.nodeOf(1).textures.empty());
  EXPECT_TRUE(s->items.nodeOf(2).transforms.empty());
  EXPECT_EQ(s->items.nodeOf(2).textures.size(), 1u);
}

TEST(Parser, DissolvesListsAndGrids) {
  const auto s = good(
      "list sphere 1 0 0 0 grid 2 2 2 sphere 1 0 0 0 scale 2 2 2 end translate 1 0 0 end rotate 0 0 1 90");
  ASSERT_EQ(s->items.objects.size(), 2u);
  EXPECT_EQ(s->items.objects[1].container, kWorld);
  const SceneNode& own = s->items.nodeOf(1);
  const SceneNode& grid = s->items.nodes.at(number(own.parent));
  const SceneNode& list = s->items.nodes.at(number(grid.parent));
  EXPECT_EQ(list.parent, kRootNode);
  EXPECT_EQ(s->items.objects[0].node, grid.parent);
  EXPECT_EQ(mapPoint(chainAt(own.transforms, {}).forward, {1, 0, 0}), (Vec3{2, 0, 0}));
  EXPECT_EQ(mapPoint(chainAt(grid.transforms, {}).forward, {1, 0, 0}), (Vec3{2, 0, 0}));
  EXPECT_LT(list.parent, s->items.objects[0].node);  // numbered when they begin
  EXPECT_LT(s->items.objects[0].node, own.parent);
}

TEST(Parser, AppliesTransformsInTheOrderWritten) {
  const auto s = good(
      "sphere 1 0 0 0 translate 1 0 0 rotate 0 0 1 90 scale 2 3 4 transform 1 0 0 0 1 0 0 0 1 5 6 7 "
      "transform 0 1 0 -1 0 0 0 0 1");
  const SceneNode& node = s->items.nodeOf(0);
  EXPECT_EQ(node.transforms.steps.size(), 1u);
  const Vec3 image = mapPoint(chainAt(node.transforms, {}).forward, {0, 0, 0});
  EXPECT_NEAR(image.x, -9, 1e-12);
  EXPECT_NEAR(image.y, 5, 1e-12);
  EXPECT_NEAR(image.z, 7, 1e-12);
}

TEST(Parser, KeepsMovingStepsApart) {
  const auto s = good(
      "define spin (time * 90) sphere 1 0 0 0 scale 2 2 2 scale 2 2 2 rotate 0 0 1 (spin) translate 1 0 0");
  const SceneNode& node = s->items.nodeOf(0);
  ASSERT_EQ(node.transforms.steps.size(), 3u);
  const Vec3 image = mapPoint(chainAt(node.transforms, {1, 0}).forward, {1, 0, 0});
  EXPECT_NEAR(image.x, 1, 1e-12);
  EXPECT_NEAR(image.y, 4, 1e-12);
}

TEST(Parser, GivesTransformsBehindATextureToTheTexture) {
  const auto s = good(
      "sphere 1 0 0 0 scale 2 2 2 texture checker diffuse 1 0 0 scale 3 3 3 translate 1 1 1 texture checker "
      "specpow 2");
  const SceneNode& node = s->items.nodeOf(0);
  ASSERT_EQ(node.textures.size(), 2u);
  EXPECT_EQ(node.transforms.steps.size(), 1u);
  EXPECT_EQ(mapPoint(chainAt(node.textures[0].transforms, {}).forward, {1, 0, 0}), (Vec3{4, 1, 1}));
  EXPECT_TRUE(node.textures[1].transforms.empty());
}

TEST(Parser, RefusesSingularTransforms) {
  EXPECT_EQ(errorOf("sphere 1 0 0 0 scale 1 0 1"),
            "s.ray:1:16: error: a singular transform: it flattens space");
  EXPECT_EQ(errorOf("sphere 1 0 0 0 transform 1 2 3 2 4 6 0 0 1"),
            "s.ray:1:16: error: a singular transform: it flattens space");
  EXPECT_EQ(errorOf("sphere 1 0 0 0 scale 1e-9 1e-9 1e-9"), "");
  EXPECT_EQ(errorOf("sphere 1 0 0 0 scale 1e200 1 1 scale 1e200 1 1"),
            "s.ray:1:32: error: the transforms up to here leave the range of numbers");
}

TEST(Parser, WarnsOfARotationAboutNothing) {
  const auto s = good("sphere 1 0 0 0\n rotate 0 0 0 45");
  ASSERT_EQ(s->warnings.size(), 1u);
  EXPECT_EQ(firstLine(s->warnings[0]), "s.ray:2:2: warning: a rotation about the axis 0 0 0 turns nothing");
}

// ---- names and CSG

TEST(Parser, KeepsNamedObjectsWhole) {
  const auto s =
      good("name n list sphere 1 0 0 0 sphere 2 0 0 0 end scale 2 2 2 object n object n translate 1 0 0");
  ASSERT_EQ(s->items.objects.size(), 4u);
  const auto& objects = s->items.objects;
  EXPECT_EQ(number(objects[0].container), 1u);
  EXPECT_EQ(objects[0].node, objects[1].node);
  EXPECT_EQ(s->items.nodeOf(0).parent, kRootNode);
  EXPECT_EQ(objects[2].container, kWorld);
  EXPECT_EQ(objects[2].node, kRootNode);
  EXPECT_EQ(number(std::get<Instance>(objects[2].body).definition), 1u);
  EXPECT_NE(objects[3].node, kRootNode);
}

TEST(Parser, MakesNamesGlobalWhereverTheyAreDefined) {
  const auto s =
      good("list name inner sphere 1 0 0 0 surface deep diffuse 4 0 0 sphere 3 0 0 0 end object deep inner");
  ASSERT_EQ(s->items.objects.size(), 3u);
  EXPECT_EQ(number(s->items.objects[0].container), 1u);
  EXPECT_EQ(s->items.objects[1].container, kWorld);
  EXPECT_EQ(s->items.red(s->items.objects[2].surface), 4);
}

TEST(Parser, LetsALaterNameHideAnEarlierOne) {
  const auto s = good("name n sphere 1 0 0 0 name m object n name n sphere 2 0 0 0 object n object m");
  EXPECT_EQ(number(std::get<Instance>(s->items.objects[3].body).definition), 3u);
  EXPECT_EQ(number(std::get<Instance>(s->items.objects[4].body).definition), 2u);
}

TEST(Parser, PutsTheOperandsOfCsgIntoADefinition) {
  const auto s = good(
      "difference sphere 1 0 0 0 translate 1 0 0 list sphere 2 0 0 0 sphere 3 0 0 0 end scale 2 2 2 end "
      "rotate 1 0 0 9");
  const auto& objects = s->items.objects;
  ASSERT_EQ(objects.size(), 5u);
  const Csg& csg = std::get<Csg>(objects[4].body);
  EXPECT_EQ(csg.operation, CsgOperation::subtract);
  EXPECT_EQ(objects[4].container, kWorld);
  EXPECT_NE(objects[4].node, kRootNode);
  EXPECT_EQ(objects[0].container, csg.operands);
  EXPECT_EQ(objects[3].container, csg.operands);
  const DefinitionId list = std::get<Instance>(objects[3].body).definition;
  EXPECT_NE(list, csg.operands);
  EXPECT_EQ(objects[1].container, list);
  EXPECT_EQ(objects[1].node, kRootNode);
  EXPECT_EQ(objects[2].container, list);
  EXPECT_EQ(s->items.nodeOf(3).transforms.steps.size(), 1u);
}

TEST(Parser, NestsCsg) {
  const auto s = good("union intersect sphere 1 0 0 0 sphere 2 0 0 0 end sphere 3 0 0 0 end");
  const auto& objects = s->items.objects;
  ASSERT_EQ(objects.size(), 5u);
  EXPECT_EQ(std::get<Csg>(objects[2].body).operation, CsgOperation::intersect);
  EXPECT_EQ(std::get<Csg>(objects[4].body).operation, CsgOperation::unite);
  EXPECT_EQ(objects[2].container, std::get<Csg>(objects[4].body).operands);
  EXPECT_EQ(objects[3].container, objects[2].container);
}

TEST(Parser, SettlesAfterEveryStatementOfTheTopLevel) {
  EXPECT_EQ(good("screen 3 3 list sphere 1 0 0 0 sphere 1 0 0 0 end sphere 1 0 0 0")->items.settledCount, 3);
}

TEST(Parser, NumbersTheSameTextTheSameWay) {
  const std::string text =
      kSurfaces + "name n list sphere red 1 0 0 0 scale 2 2 2 end object n union object n sphere 1 0 0 0 end";
  const auto one = good(text), two = good(text);
  ASSERT_EQ(one->items.objects.size(), two->items.objects.size());
  for (std::size_t i = 0; i < one->items.objects.size(); ++i)
    EXPECT_EQ(encode(one->items.objects[i]), encode(two->items.objects[i]));
}

// ---- shapes

TEST(Parser, ReadsEveryExampleOfEveryShape) {
  AllShapes::forEach([]<class T>() {
    for (const std::string_view example : T::examples) {
      const std::string text =
          std::string(T::keyword) + " red " + std::string(example) + " translate 1 2 3\n";
      const auto s = good(kSurfaces + text + "sphere 1 0 0 0");
      EXPECT_EQ(s->items.objects.size(), 2u) << text;
      EXPECT_EQ(s->warnings.size(), 0u) << text;
    }
  });
}

TEST(Parser, TellsFlatTrianglesFromPhongTriangles) {
  const auto s = good("triangle 0 0 0 1 0 0 0 1 0 triangle 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1");
  ASSERT_EQ(s->items.objects.size(), 2u);
  auto holds = [&s]<class T>(std::size_t i, T*) {
    return std::holds_alternative<T>(std::get<AnyShape>(s->items.objects[i].body));
  };
  EXPECT_TRUE(holds(0, static_cast<Triangle*>(nullptr)));
  EXPECT_TRUE(holds(1, static_cast<PhongTriangle*>(nullptr)));
}

TEST(Parser, FlipsTrianglesAndPolygonsOnlyWhenAsked) {
  const std::string text = "triangle 0 0 0 1 0 0 0 1 0 poly 0 0 0 1 0 0 0 1 0 sphere 1 0 0 0";
  auto scene = std::make_unique<Scene>();
  ParseOptions options = scene->options();
  options.flipTriangleNormals = true;
  parseSceneText(text, "s.ray", options, scene->items);
  const auto plain = good(text);
  auto body = [](const Scene& s, std::size_t i) {
    return encode(std::get<AnyShape>(s.items.objects[i].body));
  };
  EXPECT_NE(body(*scene, 0), body(*plain, 0));
  EXPECT_NE(body(*scene, 1), body(*plain, 1));
  EXPECT_EQ(body(*scene, 2), body(*plain, 2));
}

TEST(Parser, LeavesOutDegeneratePrimitivesWithAWarningOnTheirLine) {
  const auto s = good(
      "sphere 0 0 0 0\nbox 0 0 0 1 1 0\nplane 0 0 -1 0 0 0\ndisc .5 0 0 0 0 0 0\ncylinder .5 1 1 1 1 1 1\n"
      "torus 1 0 0 0 0 0 0 1\ntriangle 0 0 0 1 1 1\n 2 2 2\n\n\nsphere .8 0 0 0");
  ASSERT_EQ(s->warnings.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_TRUE(s->warnings[i].starts_with("s.ray:" + std::to_string(i + 1) + ":1: warning: degenerate "))
        << s->warnings[i];
  EXPECT_EQ(s->items.objects.size(), 1u);
}

// ---- bad aggregates

TEST(Parser, LeavesOutEmptyAggregates) {
  const auto s = good("sphere 1 0 0 0\nlist\nend\nname n list end\nobject n");
  ASSERT_EQ(s->warnings.size(), 3u);
  EXPECT_EQ(firstLine(s->warnings[0]), "s.ray:2:1: warning: empty list: it is left out");
  EXPECT_EQ(firstLine(s->warnings[2]), "s.ray:5:1: warning: object `n` is empty: it is left out");
  EXPECT_EQ(s->items.objects.size(), 1u);
  EXPECT_TRUE(s->items.nodes.empty());
}

TEST(Parser, TakesAGridOfBadSizeAsAList) {
  const auto s = good("grid 0 4 4\nsphere 1 0 0 0\nend");
  ASSERT_EQ(s->warnings.size(), 1u);
  EXPECT_TRUE(s->warnings[0].starts_with("s.ray:1:1: warning: a grid has"));
  EXPECT_EQ(s->items.objects.size(), 1u);
}

TEST(Parser, DemandsTwoOperandsOfCsg) {
  EXPECT_EQ(errorOf("\nname bad intersect\n sphere 1 0 0 0\n sphere 1 0 0 0\n sphere 1 0 0 0\nend"),
            "s.ray:2:10: error: the CSG operation `intersect` needs exactly two objects and has 3");
  EXPECT_EQ(errorOf("union sphere 1 0 0 0 end"),
            "s.ray:1:1: error: the CSG operation `union` needs exactly two objects and has 1");
}

TEST(Parser, AllowsOnlyObjectsAndSurfacesInAggregates) {
  EXPECT_EQ(errorOf("list screen 3 3 end"),
            "s.ray:1:6: error: an object or `end` is expected here, not `screen`");
  EXPECT_EQ(errorOf("union define a 3 end"),
            "s.ray:1:7: error: an operand or `end` is expected here, not `define`");
  EXPECT_EQ(errorOf("end"), "s.ray:1:1: error: a statement is expected here, not `end`");
  EXPECT_EQ(errorOf("sphere 1 0 0 0\nlist\nsphere 1 0 0 0\n"),
            "s.ray:2:1: error: this aggregate has no `end`");
}

TEST(Parser, BearsDeepNestingUpToItsLimit) {
  auto repeated = [](int count, const std::string& text) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  EXPECT_EQ(errorOf(repeated(1000, "list\n") + "sphere 1 0 0 0\n" + repeated(1000, "end\n")), "");
  EXPECT_EQ(errorOf(repeated(1001, "list\n")),
            "s.ray:1001:1: error: objects are nested more than 1000 levels deep");
  EXPECT_EQ(errorOf(repeated(100000, "union\n")),
            "s.ray:1001:1: error: objects are nested more than 1000 levels deep");
  std::string names = "name n sphere 1 0 0 0\n";
  EXPECT_EQ(errorOf(names + repeated(999, "name n object n\n")), "");
  EXPECT_EQ(errorOf(names + repeated(1000, "name n object n\n")),
            "s.ray:1001:8: error: objects are nested more than 1000 levels deep");
  EXPECT_EQ(errorOf(repeated(100000, "name n ")), "s.ray:1:8: error: an object is expected here, not `name`");
}

// ---- the head

TEST(Parser, StartsFromTheDefaultsOfRayshade) {
  const auto s = good("sphere 1 0 0 0");
  EXPECT_EQ(s->head.camera.eye, (Vec3{0, -10, 0}));
  EXPECT_EQ(s->head.picture.width, 512);
  EXPECT_EQ(s->head.settings.limits.maxDepth, 5);
  ASSERT_EQ(s->head.settings.lights.size(), 1u);  // without lights: one from (1, -1, 1)
  const auto& light = std::get<DirectionalLight>(s->head.settings.lights[0].kind);
  EXPECT_NEAR(light.toward.x, std::sqrt(1. / 3), 1e-15);
  EXPECT_NEAR(light.toward.y, -std::sqrt(1. / 3), 1e-15);
  EXPECT_EQ(s->head.settings.ambient, kWhite);
}

TEST(Parser, ReadsTheViewingStatements) {
  const auto s = good(
      "eyep 1 2 3 lookp 4 5 6 up 0 1 0 fov 30 20 screen 320 200 window 1 2 3 4 crop .9 .1 -1 2 aperture .5 "
      "focaldist 7 "
      "eyesep .25 sample 4 nojitter filter gauss contrast .1 .2 .3 cutoff .5 maxdepth -3 background .7 .8 .9 "
      "outfile dir/out.png frames 3 framelength .5 starttime 2 shutter .1 shadowtransp");
  const SceneHead& h = s->head;
  EXPECT_EQ(h.camera.eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(h.camera.target, (Vec3{4, 5, 6}));
  EXPECT_EQ(h.camera.up, (Vec3{0, 1, 0}));
  EXPECT_EQ(h.camera.horizontalFov, 30);
  EXPECT_EQ(h.camera.verticalFov, 20);
  EXPECT_EQ(h.camera.aperture, .5);
  EXPECT_EQ(h.camera.focalDistance, 7);
  EXPECT_EQ(h.camera.eyeSeparation, .25);
  EXPECT_EQ(h.picture.width, 320);
  EXPECT_EQ(h.picture.height, 200);
  EXPECT_EQ(h.picture.window, (std::array<std::int32_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(h.picture.crop, (std::array<double, 4>{.1, .9, 0, 1}));
  EXPECT_EQ(h.picture.samplesPerSide, 4);
  EXPECT_EQ(h.settings.samplesPerSide, 4);
  EXPECT_FALSE(h.picture.jitter);
  EXPECT_TRUE(h.picture.filter.gaussian);
  EXPECT_EQ(h.picture.filter.width, 1.8);
  EXPECT_EQ(h.picture.contrast, (Color{.1, .2, .3}));
  EXPECT_EQ(h.settings.limits.cutoff, (Color{.5, .5, .5}));
  EXPECT_EQ(h.settings.limits.maxDepth, 0);
  EXPECT_EQ(h.settings.background, (Color{.7, .8, .9}));
  EXPECT_EQ(h.outputFile, "dir/out.png");
  EXPECT_EQ(h.picture.frames, 3);
  EXPECT_EQ(h.picture.frameLength, .5);
  EXPECT_EQ(h.picture.startTime, 2);
  EXPECT_EQ(h.picture.shutter, .1);
  EXPECT_FALSE(h.settings.transparentShadows);
}

TEST(Parser, LetsLaterStatementsOverrideEarlierOnes) {
  const auto s = good(
      "fov 30 20 fov 50 filter gauss filter box 3 cutoff 1 2 3 resolution 10.9 20 shadowtransp shadowtransp "
      "outfile a outfile b eyep 1 2 3 rotate 0 0 1 90");
  EXPECT_EQ(s->head.camera.horizontalFov, 50);
  EXPECT_FALSE(s->head.camera.verticalFov.has_value());
  EXPECT_FALSE(s->head.picture.filter.gaussian);
  EXPECT_EQ(s->head.picture.filter.width, 3);
  EXPECT_EQ(s->head.settings.limits.cutoff, (Color{1, 2, 3}));
  EXPECT_EQ(s->head.picture.width, 10);
  EXPECT_TRUE(s->head.settings.transparentShadows);
  EXPECT_EQ(s->head.outputFile, "a");
  EXPECT_EQ(s->head.camera.eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(s->warnings.size(), 2u);
}

TEST(Parser, ReadsReports) {
  auto report = [](const std::string& text) { return good("report " + text + " screen 3 3")->head.report; };
  EXPECT_TRUE(report("").wanted);
  EXPECT_EQ(report("").everyRows, 10);
  EXPECT_TRUE(report("verbose quiet 5 log.txt").verbose);
  EXPECT_TRUE(report("verbose quiet 5 log.txt").quiet);
  EXPECT_EQ(report("verbose quiet 5 log.txt").everyRows, 5);
  EXPECT_EQ(report("verbose quiet 5 log.txt").file, "log.txt");
  EXPECT_EQ(report("log").file, "log");
  EXPECT_NE(errorOf("report 0"), "");
}

TEST(Parser, KeepsLightsInTheirOrder) {
  const auto s = good(
      "light .5 ambient light 1 point 0 0 1 light 1 2 3 directional 0 0 2 noshadow light (1 - .5) extended "
      ".5 0 0 1 "
      "light 1 area 0 0 5 1 0 5 4 0 1 5 4 light 1 spot 0 0 5 0 0 0 1 20 30 noshadow light .1 .2 .3 ambient");
  const auto& lights = s->head.settings.lights;
  ASSERT_EQ(lights.size(), 5u);
  EXPECT_TRUE(std::holds_alternative<PointLight>(lights[0].kind));
  EXPECT_EQ(lights[1].color, (Color{1, 2, 3}));
  EXPECT_FALSE(lights[1].castsShadows);
  EXPECT_EQ(lights[2].color, (Color{.5, .5, .5}));
  EXPECT_TRUE(lights[3].castsShadows);
  EXPECT_FALSE(lights[4].castsShadows);
  EXPECT_EQ(s->head.settings.ambient, (Color{.1, .2, .3}));
}

TEST(Parser, SaysWhatIsWrongWithALight) {
  EXPECT_TRUE(errorOf("\nlight 1 directional 0 0 0").starts_with("s.ray:2:9: error: a directional light"));
  EXPECT_TRUE(errorOf("light 1 area 0 0 0 1 0 0 0 0 1 0 1").starts_with("s.ray:1:9: error: an area light"));
  EXPECT_EQ(errorOf("light 1 sun 0 0 0"), "s.ray:1:9: error: a kind of light is expected here, not `sun`");
}

TEST(Parser, ReadsTheAtmosphere) {
  const auto s = good("atmosphere 1.5 fog 1 1 1 2 2 2 mist 1 1 1 2 2 2 0 1");
  EXPECT_EQ(s->head.settings.airIndex, 1.5);
  EXPECT_EQ(s->head.settings.atmosphere.size(), 2u);
  EXPECT_EQ(good("atmosphere fog 1 1 1 2 2 2 atmosphere 2")->head.settings.atmosphere.size(), 0u);
  EXPECT_NE(errorOf("atmosphere 0"), "");
}

TEST(Parser, PrintsValues) {
  EXPECT_EQ(good("define e (10 / 3) print (e * 3) print 5 print (-2 + 3 - -4)")->printed,
            (std::vector<std::string>{"10.000000", "5.000000", "5.000000"}));
}

std::string headError(const std::string& text) {
  try {
    checkHead(good(text)->head, "s.ray");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(Parser, ChecksTheHeadAtTheEnd) {
  EXPECT_EQ(headError(""), "");
  EXPECT_EQ(headError("up 0 8 -1 eyep 0 -8 1"), "s.ray: error: the direction of view is parallel to up");
  EXPECT_NE(headError("eyep 0 0 0").find("the same point"), std::string::npos);
  EXPECT_NE(headError("sample 9").find("sample count of 9"), std::string::npos);
  EXPECT_NE(headError("sample 0").find("sample"), std::string::npos);
  EXPECT_NE(headError("screen 100 100 window 0 100 0 99").find("window"), std::string::npos);
  EXPECT_EQ(headError("screen 100 100 window 0 99 0 99"), "");
  EXPECT_NE(headError("screen 0 100").find("screen"), std::string::npos);
  EXPECT_NE(headError("screen 1000000000 1000000000").find("screen"), std::string::npos);
  EXPECT_NE(headError("fov 180").find("fov"), std::string::npos);
  EXPECT_NE(headError("frames 0").find("frames"), std::string::npos);
}

TEST(Parser, ChecksStereoPictures) {
  SceneHead head = good("")->head;
  head.camera.eyeShown = Camera::Eye::left;
  EXPECT_THROW(checkHead(head, "s.ray"), SceneError);
  head.camera.eyeSeparation = 1;
  EXPECT_NO_THROW(checkHead(head, "s.ray"));
}

// ---- errors

TEST(Parser, ShowsPlaceLineAndCaret) {
  EXPECT_EQ(parse("surface red diffuse 1 0 0\nsphere red 1 0 0 0\n\tbox chrome 0 0 0 1 1 1\n")->errors,
            "s.ray:3:6: error: undefined surface `chrome`\n"
            "  \tbox chrome 0 0 0 1 1 1\n"
            "  \t    ^");
}

TEST(Parser, NamesWhatIsMissing) {
  EXPECT_EQ(errorOf("sphere late 1 0 0 0\nsurface late"), "s.ray:1:8: error: undefined surface `late`");
  EXPECT_EQ(errorOf("object thing"), "s.ray:1:8: error: undefined object `thing`");
  EXPECT_EQ(errorOf("name n object n"), "s.ray:1:15: error: undefined object `n`");
  EXPECT_EQ(errorOf("sphere (radius * 2) 0 0 0"), "s.ray:1:9: error: `radius` is not defined");
  EXPECT_EQ(errorOf("spheres 1 0 0 0"), "s.ray:1:1: error: a statement is expected here, not `spheres`");
  EXPECT_EQ(errorOf("sphere 1 0 0"), "s.ray:1:13: error: a number is expected here, not the end of the text");
  EXPECT_EQ(errorOf("sphere -(3) 0 0 0"), "s.ray:1:9: error: a number is expected here, not `(`");
  EXPECT_EQ(errorOf("surface map"),
            "s.ray:1:9: error: `map` is a reserved word and cannot be the name of a surface");
  EXPECT_EQ(errorOf("sphere 1 0 0 0 texture gravel"),
            "s.ray:1:24: error: a texture is expected here, not `gravel`");
  EXPECT_EQ(errorOf("sphere 1 0 0 0 texture checker scale 2 2 2"),
            "s.ray:1:32: error: a surface is expected here, not `scale`");
  EXPECT_EQ(errorOf("define a 3 define a 4"), "s.ray:1:19: error: `a` is defined already");
  EXPECT_EQ(errorOf("define pi 3"), "s.ray:1:8: error: `pi` is defined already");
}

TEST(Parser, AllowsTimeOnlyInTransformsAndVariables) {
  EXPECT_EQ(errorOf("sphere (time) 0 0 0"),
            "s.ray:1:8: error: this depends on time: only transforms and variables may");
  EXPECT_EQ(errorOf("define t (frame) sphere 1 0 0 0 translate (t) 0 0"), "");
  EXPECT_NE(errorOf("define t (frame) surface a specpow (t)"), "");
}

TEST(Parser, GoesOnAtTheNextStatementAfterAnError) {
  const auto s = parse(
      "spheres 1\nsphere red 1 0 0 0\nsphere 1 0 0 x\nbox 0 0 0 1 1 1\nlist\n sphere grey 1 0 0 0\n box "
      "nix\nend\nsphere blue 1 0 0 0");
  EXPECT_EQ(linesOf(s->errors), (std::vector<int>{1, 2, 3, 6, 7, 9}));
}

TEST(Parser, GoesOnInsideOfAggregatesAfterAnError) {
  const auto s = parse(
      "grid 3 3\n list\n  sphere nix 1 0 0 0\n  name ball sphere 1 0 0 0\n  surface red diffuse 1 0 0\n end\n"
      " union sphere nix 1 0 0 0\n  box 1 2\n end\nend\nobject red ball\nlist\n box 3\nend rotate 1\n"
      "sphere 1\n");
  EXPECT_EQ(linesOf(s->errors), (std::vector<int>{2, 3, 7, 9, 14, 15, 16})) << s->errors;
}

TEST(Parser, SaysOnceThatAnEndIsForgotten) {
  const auto s = parse("list\n sphere 1 0 0 0\nlight 1 point 0 0 0\nscreen 3 3\nsphere nix 1 0 0 0\nfov 3\n");
  EXPECT_EQ(linesOf(s->errors), (std::vector<int>{3, 5})) << s->errors;
}

TEST(Parser, TakesAReservedWordInTheMiddleOfALineForNoStatement) {
  EXPECT_EQ(
      linesOf(
          parse("surface sphere diffuse 1 1 1\nsphere surface 1 0 0 0\nname list sphere 1 0 0 0\n")->errors),
      (std::vector<int>{1, 2, 3}));
}

TEST(Parser, TellsTheSinkNothingBehindAnError) {
  const auto s = parse("sphere 1 0 0 0\nspheres\nsphere 1 0 0 0");
  EXPECT_EQ(s->items.objects.size(), 1u);
  EXPECT_EQ(s->items.settledCount, 1);
}

TEST(Parser, DoesNotComplainOfTheUsesOfABadDefinition) {
  const auto s = parse(
      "surface red diffuse 1 x\nsphere red 1 0 0 0\nname n sphere 1 0\nobject n\ndefine a (b)\nsphere (a) 0 "
      "0 0\n"
      "name m list\n sphere 1\nend\nunion object m sphere 1 0 0 0 end\nname k list object m end object k\n");
  EXPECT_EQ(linesOf(s->errors), (std::vector<int>{1, 4, 5, 9})) << s->errors;
  EXPECT_TRUE(s->warnings.empty()) << s->warnings[0];
}

TEST(Parser, StopsAfterTwentyErrors) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "sphere nix 1 0 0 0\n";
  const auto s = parse(text);
  EXPECT_NE(s->errors.find("s.ray:20:"), std::string::npos);
  EXPECT_EQ(s->errors.find("s.ray:21:"), std::string::npos);
}

TEST(Parser, StopsAtOnceWhenTheTextIsNoText) {
  const auto s = parse(std::string("x\x9b\xb4\xca\0\0\x7f", 7));
  EXPECT_NE(s->errors.find("s.ray:1:2: error: unexpected byte 0x9b"), std::string::npos);
}

TEST(Parser, SaysThatANumberIsTooLarge) {
  EXPECT_EQ(errorOf("sphere 1 0 0 0\nsphere 1e400 0 0 0"), "s.ray:2:8: error: the number 1e400 is too large");
  EXPECT_NE(errorOf("screen 1e10 5").find("out of range"), std::string::npos);
}

// ---- files and the preprocessor

TEST(Parser, NamesAMissingFile) {
  EXPECT_EQ(parseFile("tests/data/parser/nowhere.ray")->errors,
            "tests/data/parser/nowhere.ray: error: cannot be read: No such file or directory");
  EXPECT_NE(parseFile("tests/data")->errors, "");
}

TEST(Parser, RunsThePreprocessorWhereADirectiveIs) {
  const auto s = parseFile("tests/data/parser/macros.ray", "-DRADIUS=2.5");
  EXPECT_EQ(s->errors, "");
  ASSERT_EQ(s->items.objects.size(), 2u);
  EXPECT_EQ(std::get<Sphere>(std::get<AnyShape>(s->items.objects[1].body)).radius, 2.5);
}

TEST(Parser, NamesTheFileAndLineOfTheSourceNotOfThePreprocessor) {
  const auto s = parseFile("tests/data/parser/macros_and_error.ray");
  EXPECT_EQ(firstLine(s->errors),
            "tests/data/parser/macros_and_error.ray:7:1: error: a statement is expected here, not `spheres`");
  EXPECT_EQ(s->items.objects.size(), 2u);
}

TEST(Parser, RefusesDirectivesWhenItMayNotPreprocess) {
  Scene scene;
  ParseOptions options = scene.options();
  options.fileName = "tests/data/parser/macros.ray";
  options.preprocess = false;
  EXPECT_THROW(parseScene(options, scene.items), SceneError);
}

TEST(Parser, EndsWhenAFileIncludesItself) {
  const auto once = parseFile("tests/data/bad/include_self.ray");
  EXPECT_NE(once->errors.find("tests/data/bad/include_self.ray:4: error: #include nested"), std::string::npos)
      << once->errors;
  EXPECT_NE(parseFile("tests/data/bad/include_self_twice.ray")->errors.find("#include"), std::string::npos);
}

TEST(Parser, BelievesTheExitStatusOfThePreprocessor) {
  const auto s = parseFile("tests/data/bad/include_missing.ray");
  EXPECT_TRUE(s->errors.starts_with("tests/data/bad/include_missing.ray:")) << s->errors;
  EXPECT_NE(s->errors.find("nowhere.inc"), std::string::npos);
  EXPECT_NE(parseFile("tests/data/bad/open_comment.ray")->errors.find("open_comment.ray:2:"),
            std::string::npos);
}

}  // namespace
}  // namespace rayshade
