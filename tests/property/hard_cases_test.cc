// The hard numerical cases of docs/hard-cases.md that have no other place, and the check of that table.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "rayshade/base/roots.h"
#include "rayshade/shapes/all.h"
#include "rayshade/space/clip_list.h"
#include "tests/support/compare_pictures.h"
#include "tests/support/number_text.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

// One ray, from the eye to the target.
Color colorSeen(const std::string& eye, const std::string& target, const std::string& scene) {
  const Rendered r = renderSequentially(
      jobOfText("screen 1 1 sample 1 nojitter fov 1e-7 1e-7 eyep " + eye + " lookp " + target + " " + scene));
  const std::vector<float>& p = r.frames.at(0).pixels;
  return {p[0], p[1], p[2]};
}

TEST(HardCase, TwoNearlyEqualRootsAreTwo) {
  // The discriminant of b^2 - a c with 27 equal digits, as it comes up: a ray 2^-52 below the top of a sphere.
  const LocalRay ray{{-3, 1 - 0x1p-52, 0}, {1, 0, 0}};
  const double half = std::sqrt(0x1p-51 - 0x1p-104);  // sqrt(1 - (1 - 2^-52)^2)
  const double first = Sphere{}.intersect(ray, 0), second = Sphere{}.intersect(ray, first);
  EXPECT_NEAR(first, 3 - half, 1e-15);
  EXPECT_NEAR(second, 3 + half, 1e-15);
}

TEST(HardCase, TheSmallRootOfAQuadraticDoesNotCancel) {
  const Roots roots = rootsBetween(Cubic{1, -1e8, 1, 0}, 0, 2e8);
  ASSERT_EQ(roots.count, 2u);
  EXPECT_NEAR(roots.at[0], 1.0000000000000001e-8, 2e-24);
  EXPECT_NEAR(roots.at[1], 99999999.99999999, 1.5e-8);
}

TEST(HardCase, ATeapotInAStadiumIsTheSamePictureInAnyNumberOfVoxels) {
  const Job job = jobOfText(
      "screen 24 18 sample 1 nojitter eyep 0 -3e-6 1e-6 lookp 0 0 0 fov 60 background .1 .2 .3 light 1 point "
      "-5e-6 -5e-6 9e-6 "
      "surface s diffuse .7 .5 .3 sphere s 1 2e6 2e6 0 sphere s 1 -2e6 -2e6 0 "
      "sphere s 4e-7 0 0 0 torus s 8e-7 2e-7 0 0 0 0 1 1 box s -1e-6 1e-6 -1e-6 1e-6 2e-6 1e-6");
  const Rendered one = renderSequentially(job);
  for (const std::uint32_t voxels : {2u, 8u, 100u})
    EXPECT_EQ(difference(renderSequentially(job, voxels).frames, one.frames), "") << voxels;
  std::set<float> levels(one.frames[0].pixels.begin(), one.frames[0].pixels.end());
  EXPECT_GT(levels.size(), 20u);
}

TEST(HardCase, RaysThatBeginInTheNeighbourVoxelAreNotLost) {
  // Space is cut where the box and the floor are, so that every shadow ray and every reflected one begins on a border, give
  // or take its offset.
  const Job job = jobOfText(
      "screen 32 24 sample 1 nojitter maxdepth 4 eyep 3 -6 3 lookp 0 0 0 fov 45 light 1 point -4 -4 6 "
      "surface m ambient .1 .1 .1 diffuse .6 .5 .4 specular .8 .8 .8 reflect .6 "
      "box m -1 -1 0 1 1 1 box m -2 -2 -1 2 2 0 sphere m .5 0 0 1.5");
  const Rendered one = renderSequentially(job);
  for (const std::uint32_t voxels : {2u, 4u, 8u, 64u})
    EXPECT_EQ(difference(renderSequentially(job, voxels).frames, one.frames), "") << voxels;
}

TEST(HardCase, APlaneInAllVoxelsCountsOnce) {
  const std::string scene =
      "background 1 1 1 cutoff 0 maxdepth 9 surface g transp .5 index 1 plane g 0 0 0 0 0 1 sphere g 1 9 9 9";
  const Job job = jobOfText("screen 1 1 sample 1 nojitter fov 1e-7 1e-7 eyep 1 2 5 lookp 0 0 0 " + scene);
  for (const std::uint32_t voxels : {1u, 8u, 64u})
    EXPECT_NEAR(renderSequentially(job, voxels).frames[0].pixels[0], .5, 1e-6)
        << voxels;  // one filter, not two
}

TEST(HardCase, FarFromTheOriginNothingShadowsItself) {
  for (const double far : {1e6, 1e9, 1e12}) {
    const auto scene = [&](const std::string& shadows) {
      return jobOfText("screen 40 40 sample 1 nojitter fov 25 eyep" + text(far) + text(-5) + "0 lookp" +
                       text(far) + "0 0 light 1 directional 0 -1 .3 " + shadows +
                       " surface s diffuse 1 1 1 sphere s 1" + text(far) + "0 0");
    };
    const Rendered with = renderSequentially(scene("")), without = renderSequentially(scene("noshadow"));
    EXPECT_EQ(difference(with.frames, without.frames), "") << far;
    float most = 0;
    for (const float p : without.frames[0].pixels) most = std::max(most, p);
    EXPECT_GT(most, .9f) << far;
  }
}

TEST(HardCase, AnOccluderCountsIfItIsNearerThanTheLight) {
  const std::string scene =
      "up 0 1 0 light 1 point 0 0 4 surface s diffuse 1 1 1 plane s 0 0 0 0 0 1 disc s 1 0 0";
  EXPECT_NEAR(colorSeen("10 0 5", "0 0 0", scene + text(4) + "0 0 1").r, 1, 1e-6);
  EXPECT_EQ(colorSeen("3 0 3", "0 0 0", scene + text(4 - 1e-12) + "0 0 1").r, 0);
}

TEST(HardCase, WhatShrinksToNothingIsGoneAndComesBack) {
  const auto seenAt = [](double time) {
    return colorSeen("0 0 5", "0 0 0.1",
                     "up 0 1 0 starttime" + text(time) +
                         "light 1 ambient surface s ambient 1 1 1 sphere s 1 0 0 0 scale (1 - time) "
                         "(1 - time) (1 - time)")
        .r;
  };
  EXPECT_EQ(seenAt(0.5), 1);
  EXPECT_EQ(seenAt(1), 0);
  EXPECT_EQ(seenAt(1.5), 1);
}

TEST(HardCase, AHallOfMirrorsIsAsDeepAsMemory) {
  const Job job = jobOfText(
      "screen 4 3 sample 1 nojitter eyep 0 -10 2 lookp 0 0 0 maxdepth 100000 light 1 ambient "
      "surface m ambient 1e-5 1e-5 1e-5 specular 1 1 1 reflect 1 sphere m 100 0 0 0 sphere m 1 0 3 0");
  const Rendered r = renderSequentially(job);
  EXPECT_GT(r.counts.reflectedRays, 1000000u);
  for (const float p : r.frames.at(0).pixels) EXPECT_NEAR(p, 1, 0.01);
}

TEST(HardCase, APointOnTheLightIsANumber) {
  const Rendered r = renderSequentially(
      jobOfText("screen 9 9 sample 1 nojitter eyep 0 0 5 lookp 0 0 0 up 0 1 0 fov 5 light 1 point 0 0 0 "
                "light 1 area -1 -1 0 "
                "1 -1 0 2 -1 1 0 2 surface s ambient .2 .2 .2 diffuse 1 1 1 plane s 0 0 0 0 0 1"));
  for (const float p : r.frames[0].pixels) EXPECT_TRUE(std::isfinite(p));
}

// The mean cosine at a point 2 below the centre of a 2 x 2 light, without a cosine at the light: rayshade's area light is a
// grid of points.  The form factor of the radiator (0.2394564704607735) has both cosines and the square of the distance.
TEST(HardCase, AnAreaLightIsTheMeanOfItsPoints) {
  const std::string scene =
      "up 0 1 0 light 1 area -1 -1 2 1 -1 2 64 -1 1 2 64 surface s diffuse 1 1 1 plane s 0 0 0 0 0 1 ";
  double mean = 0;
  for (int i = 0; i < 400; ++i)
    for (int k = 0; k < 400; ++k) {
      const double x = (i + .5) / 200 - 1, y = (k + .5) / 200 - 1;
      mean += 2 / std::sqrt(4 + x * x + y * y) / 160000;
    }
  EXPECT_NEAR(colorSeen("10 0 5", "0 0 0", scene).r, mean, 1e-4);
  EXPECT_NEAR(colorSeen("3 0 .5", "0 0 0", scene + "polygon s 0 -9 1 9 -9 1 9 9 1 0 9 1").r, mean / 2, 1e-4);
}

TEST(HardCase, CellsAtTheSameDistanceComeInAFixedOrder) {
  const BinTree tree = buildBinTree({{-1, -1, -1}, {1, 1, 1}}, {.voxels = 8});
  const Pyramid pyramid =
      pyramidOf({0, 0, 0}, {Vec3{-1, -1, 3}, Vec3{1, -1, 3}, Vec3{1, 1, 3}, Vec3{-1, 1, 3}});
  const std::vector<CellId> list = clipList(tree, pyramid);
  // At a plane with the apex on it the high side comes first: it owns the apex.
  ASSERT_GE(list.size(), 4u);
  EXPECT_EQ(boundsOf(tree, list[0]).low, (Vec3{0, 0, 0}));
  EXPECT_EQ(list, clipList(tree, pyramid));
}

TEST(HardCase, FacesOfTwoMediaThatCoincideAreOneInterfaceForTheEye) {
  // A box of glass in a box of water with a common face: through it one sees the sky, not black.
  const std::string scene =
      "background 1 1 1 cutoff 0 maxdepth 12 surface water transp 1 index 1.33 surface glass transp 1 index "
      "1.5 "
      "box water -1 -1 0 1 1 1 box glass -1 -1 1 1 1 2 ";
  for (const char* eye : {"0 0 9", ".3 .2 9", "2 1 9"}) {
    const Color c = colorSeen(eye, "0 0 1", "up 0 1 0 " + scene);
    EXPECT_GT(c.r, .9) << eye;
  }
}

TEST(HardCase, CoordinatesAtPolesAndSeamsAreFinite) {
  const auto demand = [](const auto& shape, const LocalRay& ray) {
    const double t = shape.intersect(ray, 0);
    ASSERT_NE(t, kNoHit);
    const ShapePoint at = shape.pointAt(ray, t);
    const SurfaceCoordinates c = shape.coordinates(at, at.position);
    EXPECT_TRUE(std::isfinite(c.u) && std::isfinite(c.v));
    EXPECT_TRUE(isFinite(c.dpdu) && isFinite(c.dpdv));
  };
  for (const double z : {1.0, -1.0}) demand(Sphere{}, {{0, 0, 5 * z}, {0, 0, -z}});
  for (const double y : {0.0, -0.0, 5e-324, -5e-324, 1e-17, -1e-17}) {
    demand(Sphere{}, {{5, y, 0}, {-1, 0, 0}});
    demand(Cylinder{{{0, 0, 0}, {0, 0, 1}, 1, 1, 1}}, {{5, y, .5}, {-1, 0, 0}});
    demand(Torus{}, {{5, y, 0}, {-1, 0, 0}});
    demand(Disc{}, {{y, y, 5}, {0, 0, -1}});
  }
}

TEST(HardCase, TheFaceBetweenTouchingBoxesOfAUnionIsNeverSeen) {
  const std::string scene =
      "background 1 1 1 cutoff 0 maxdepth 9 surface g transp .5 index 1 union box g 0 0 0 1 1 1 box g 1 0 0 "
      "2 1 1 end ";
  EXPECT_NEAR(colorSeen("-5 .5 .5", "0 .5 .5", "up 0 0 1 " + scene).r, .25,
              1e-6);  // in and out, nothing between
}

TEST(HardCase, ProductsAndSumsAreNotFused) {
  volatile double a = 1 + 0x1p-30, b = 1 - 0x1p-30, c = -1;  // a b = 1 - 2^-60, which rounds to 1
  const double x = a, y = b, z = c;
  EXPECT_EQ(x * y + z, 0);
  EXPECT_EQ(std::fma(x, y, z), -0x1p-60);
}

TEST(HardCase, FogThatLeavesNothingAndColoursWithoutEndAreNumbers) {
  const Rendered r = renderSequentially(
      jobOfText("screen 9 9 sample 1 nojitter eyep 0 0 1e5 lookp 0 0 0 up 0 1 0 atmosphere fog .5 .5 "
                ".5 100 .1 1e-9 light 1e30 point 0 0 9 "
                "surface s ambient 1e30 1e30 1e30 diffuse 1e30 1e30 1e30 extinct 1e-300 "
                "transp .5 plane s 0 0 0 0 0 1 plane s 0 0 -1e9 0 0 1"));
  for (const float p : r.frames[0].pixels) {
    EXPECT_TRUE(std::isfinite(p));
    EXPECT_GE(p, 0);
  }
}

std::string fileText(const std::filesystem::path& name) {
  std::ifstream in(name);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Each of the 92 cases has its row, and each row names tests that there are.
TEST(HardCases, TheTableIsWholeAndNamesTestsThatAreThere) {
  std::set<std::string> tests;
  const std::regex declared(R"((?:TEST|TEST_F|TEST_P|TYPED_TEST)\(\s*(\w+),\s*(\w+)\))");
  for (const auto& entry : std::filesystem::recursive_directory_iterator("tests")) {
    if (entry.path().extension() != ".cc") continue;
    const std::string source = fileText(entry.path());
    for (std::sregex_iterator at(source.begin(), source.end(), declared), end; at != end; ++at)
      tests.insert((*at)[1].str() + "." + (*at)[2].str());
  }
  const std::string table = fileText("docs/hard-cases.md");
  std::set<std::string> cases;
  const std::regex row(R"(\n- ([A-F]\d+) ([^\n]*))"), named(R"(`(\w+\.\w+)`)");
  for (std::sregex_iterator at(table.begin(), table.end(), row), end; at != end; ++at) {
    EXPECT_TRUE(cases.insert((*at)[1]).second) << (*at)[1];
    const std::string cells = (*at)[2];
    int count = 0;
    for (std::sregex_iterator test(cells.begin(), cells.end(), named); test != end; ++test, ++count)
      EXPECT_TRUE(tests.contains((*test)[1])) << (*at)[1] << ": there is no " << (*test)[1];
    EXPECT_GT(count, 0) << (*at)[1];
  }
  EXPECT_EQ(cases.size(), 18u + 11 + 15 + 18 + 16 + 14);
}

}  // namespace
}  // namespace rayshade
