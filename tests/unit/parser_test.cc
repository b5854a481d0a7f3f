// Objects as they are written: surfaces, nodes, names, aggregates, shapes.
// guarded: reads text of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/parser.h"

#include <gtest/gtest.h>

#include "rayshade/language/surface_table.h"
#include "tests/support/parsed_text.h"

namespace rayshade {
namespace {

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
  EXPECT_EQ(mapPoint(chainAt(own.transforms, {})->forward, {1, 0, 0}), (Vec3{2, 0, 0}));
  EXPECT_EQ(mapPoint(chainAt(grid.transforms, {})->forward, {1, 0, 0}), (Vec3{2, 0, 0}));
  EXPECT_LT(list.parent, s->items.objects[0].node);  // numbered when they begin
  EXPECT_LT(s->items.objects[0].node, own.parent);
}

TEST(Parser, AppliesTransformsInTheOrderWritten) {
  const auto s = good(
      "sphere 1 0 0 0 translate 1 0 0 rotate 0 0 1 90 scale 2 3 4 transform 1 0 0 0 1 0 0 0 1 5 6 7 "
      "transform 0 1 0 -1 0 0 0 0 1");
  const SceneNode& node = s->items.nodeOf(0);
  EXPECT_EQ(node.transforms.steps.size(), 1u);
  const Vec3 image = mapPoint(chainAt(node.transforms, {})->forward, {0, 0, 0});
  EXPECT_NEAR(image.x, -9, 1e-12);
  EXPECT_NEAR(image.y, 5, 1e-12);
  EXPECT_NEAR(image.z, 7, 1e-12);
}

TEST(Parser, KeepsMovingStepsApart) {
  const auto s = good(
      "define spin (time * 90) sphere 1 0 0 0 scale 2 2 2 scale 2 2 2 rotate 0 0 1 (spin) translate 1 0 0");
  const SceneNode& node = s->items.nodeOf(0);
  ASSERT_EQ(node.transforms.steps.size(), 3u);
  const Vec3 image = mapPoint(chainAt(node.transforms, {1, 0})->forward, {1, 0, 0});
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
  EXPECT_EQ(mapPoint(chainAt(node.textures[0].transforms, {})->forward, {1, 0, 0}), (Vec3{4, 1, 1}));
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
  auto scene = std::make_unique<ParsedText>();
  ParseOptions options = scene->options();
  options.flipTriangleNormals = true;
  parseSceneText(text, "s.ray", options, scene->items);
  const auto plain = good(text);
  auto body = [](const ParsedText& s, std::size_t i) {
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

TEST(Parser, RefusesTransformsThatHaveNoInverseTogether) {
  EXPECT_EQ(errorOf("sphere 1 0 0 0\n  scale 1e17 1 1 rotate 1 2 3 33 scale 1e-17 1 1"),
            "s.ray:2:3: error: these transforms together lose all digits: there is no way back");
  EXPECT_EQ(errorOf("sphere 1 0 0 0 scale 1e-200 1 1 scale 1e200 1 1"), "");
}

TEST(Parser, DemandsTwoOperandsOfCsgAndTakesMore) {
  const auto s = good("\nname bad difference\n sphere 1 0 0 0\n sphere 1 0 0 0\n sphere 1 0 0 0\nend");
  ASSERT_EQ(s->warnings.size(), 1u);
  EXPECT_EQ(firstLine(s->warnings[0]),
            "s.ray:2:10: warning: the CSG operation `difference` has 3 objects, in Rayshade 4 it has two: "
            "all others "
            "are taken from the first");
  EXPECT_EQ(errorOf("union sphere 1 0 0 0 end"),
            "s.ray:1:1: error: the CSG operation `union` needs two objects and has 1");
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

}  // namespace
}  // namespace rayshade
