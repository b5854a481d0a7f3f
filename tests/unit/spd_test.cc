// The generator of the standard scenes: how many primitives each size has, and some places known from the
// published scenes.
// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/spd/spd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace rayshade::spd {
namespace {

struct Ball {
  Vec3 centre;
  double radius;
};

// Keeps everything; for small scenes.
class Recorder : public SceneWriter {
 public:
  std::uint64_t announced = 0, crowd = 0, lights = 0, materials = 0, polygons = 0, cylinders = 0, cones = 0;
  std::vector<Ball> balls;
  std::vector<std::array<Vec3, 3>> triangles, normals;
  bool finished = false;

  void view(const View&) override {}
  void light(Vec3, double) override { ++lights; }
  MaterialId material(const Material&) override { return MaterialId(materials++); }
  void beginCrowd(std::uint64_t primitives) override { announced = primitives, counting_ = true; }
  void endCrowd() override { counting_ = false; }
  void sphere(MaterialId, Vec3 centre, double radius) override { balls.push_back({centre, radius}), count(); }
  void cylinder(MaterialId, double, Vec3, Vec3) override { ++cylinders, count(); }
  void cone(MaterialId, double, Vec3, double, Vec3) override { ++cones, count(); }
  void polygon(MaterialId, std::span<const Vec3>) override { ++polygons, count(); }
  void triangle(MaterialId, const Vec3 (&p)[3]) override { triangles.push_back({p[0], p[1], p[2]}), count(); }
  void smoothTriangle(MaterialId material, const Vec3 (&p)[3], const Vec3 (&n)[3]) override {
    triangle(material, p);
    normals.push_back({n[0], n[1], n[2]});
  }
  void finish() override { finished = true; }

 private:
  void count() { crowd += counting_; }
  bool counting_ = false;
};

Recorder record(std::string_view name, int size) {
  Recorder recorder;
  EXPECT_TRUE(writeScene({name, size}, recorder)) << name << ' ' << size;
  return recorder;
}

// The known places have six significant digits.
bool near(double value, double known) {
  return std::abs(value - known) <= 6e-6 * std::max(1.0, std::abs(known));
}

bool hasBall(const Recorder& scene, Vec3 centre, double radius) {
  for (const Ball& ball : scene.balls) {
    if (near(ball.centre.x, centre.x) && near(ball.centre.y, centre.y) && near(ball.centre.z, centre.z) &&
        near(ball.radius, radius)) {
      return true;
    }
  }
  return false;
}

TEST(Spd, EverySceneAnnouncesWhatItWrites) {
  for (const SceneKind& kind : sceneKinds()) {
    for (const int size : {1, 2, 3}) {
      const Recorder scene = record(kind.name, size);
      EXPECT_EQ(scene.announced, scene.crowd) << kind.name << ' ' << size;
      EXPECT_TRUE(scene.finished);
    }
  }
}

TEST(Spd, UsualSizesHaveThePublishedCounts) {
  EXPECT_EQ(record("balls", 4).balls.size(), 7381u);
  EXPECT_EQ(record("gears", 4).polygons, 9345u);
  EXPECT_EQ(record("lattice", 12).balls.size(), 2197u);
  EXPECT_EQ(record("lattice", 12).cylinders, 6084u);
  EXPECT_EQ(record("mount", 6).triangles.size(), 8192u);
  EXPECT_EQ(record("mount", 6).balls.size(), 4u);
  EXPECT_EQ(record("rings", 7).balls.size(), 4200u);
  EXPECT_EQ(record("rings", 7).cylinders, 4200u);
  EXPECT_EQ(record("shells", 9).balls.size(), 5761u);
  EXPECT_EQ(record("teapot", 12).triangles.size(), 9120u);
  EXPECT_EQ(record("teapot", 12).polygons, 144u);
  EXPECT_EQ(record("tetra", 6).triangles.size(), 4096u);
  EXPECT_EQ(record("tree", 11).cones, 4095u);
  EXPECT_EQ(record("tree", 11).balls.size(), 4095u);
}

TEST(Spd, SizeZeroIsTheUsualOne) { EXPECT_EQ(record("tetra", 0).triangles.size(), 4096u); }

TEST(Spd, UnknownScenesAndSizesAreRefused) {
  Recorder recorder;
  EXPECT_FALSE(writeScene({"ball", 4}, recorder));
  EXPECT_FALSE(writeScene({"balls", -1}, recorder));
  EXPECT_FALSE(writeScene({"balls", 1000}, recorder));
  EXPECT_FALSE(recorder.finished);
}

TEST(Spd, BallsTouchTheirParentsInTheKnownPlaces) {
  const Recorder scene = record("balls", 3);
  EXPECT_TRUE(hasBall(scene, {0.272166, 0.272166, 0.544331}, 0.166667));
  EXPECT_TRUE(hasBall(scene, {0.643951, 0.172546, 0}, 0.166667));
  EXPECT_TRUE(hasBall(scene, {0.304709, 0.461844, 0.43322}, 0.0555556));
  EXPECT_TRUE(hasBall(scene, {0.470715, 0.470715, 0.598245}, 0.0185185));
}

TEST(Spd, OtherScenesHaveTheKnownPlaces) {
  EXPECT_TRUE(hasBall(record("tree", 3), {0.594216, 0.406804, 1.98278}, 0.0302267));
  EXPECT_TRUE(hasBall(record("rings", 1), {-0.465497, 1.97242, -0.489453}, 0.07412));
  EXPECT_TRUE(hasBall(record("mount", 1), {-0.749194, 0.98961, 0.930598}, 0.17));
  EXPECT_TRUE(hasBall(record("shells", 9), {0, 16.902, -33.804}, 16.902));
}

TEST(Spd, TeapotNormalsAreUnitVectorsEvenAtThePoles) {
  for (const auto& corners : record("teapot", 3).normals) {
    for (const Vec3& normal : corners) EXPECT_NEAR(length(normal), 1, 1e-12);
  }
}

TEST(Spd, MountainHasTheKnownHeights) {
  const auto coarse = record("mount", 6).triangles;
  EXPECT_NEAR(coarse[0][1].z, -0.0160409, 6e-7);
  EXPECT_NEAR(coarse[2][2].z, 0.0317726, 6e-7);
  EXPECT_NEAR(coarse[4][2].z, 0.0669606, 6e-7);
  const auto fine = record("mount", 8).triangles;
  EXPECT_NEAR(fine[0][2].z, -0.0228732, 6e-7);
  EXPECT_NEAR(fine[4][2].z, -0.0428655, 6e-7);
}

TEST(Spd, MountainHasNoGaps) {
  std::map<std::pair<double, double>, double> heights;
  for (const auto& corners : record("mount", 4).triangles) {
    for (const Vec3& corner : corners) {
      const auto [known, isNew] = heights.try_emplace({corner.x, corner.y}, corner.z);
      EXPECT_TRUE(isNew || known->second == corner.z);
    }
  }
  EXPECT_EQ(heights.size(), 17u * 17u);
}

std::string text(std::string_view format, bool grid, std::string_view name, int size) {
  std::ostringstream out;
  const auto writer = makeWriter({.format = format, .grid = grid}, out);
  EXPECT_TRUE(writer && writeScene({name, size}, *writer));
  return out.str();
}

TEST(Spd, RayshadeTextIsTheKnownOne) {
  const std::string scene = text("rayshade", false, "lattice", 12);
  EXPECT_NE(scene.find("eyep 0.541667 1 0.958333\nlookp 0.541667 -1 -1.04167\nup 0.2 1 0\nfov 60 60\n"),
            std::string::npos);
  EXPECT_NE(scene.find("light 0.408248 0.408248 0.408248 point 2 0.5 0.5\n"), std::string::npos);
  EXPECT_NE(scene.find("sphere M0 0.0208333 0 0 0.0833333\n"), std::string::npos);
  EXPECT_EQ(scene.find("grid"), std::string::npos);
  EXPECT_NE(text("rayshade", true, "balls", 4).find("grid 29 29 29\n"), std::string::npos);
}

TEST(Spd, OtherLanguagesAreWritten) {
  EXPECT_NE(text("pov", false, "balls", 1).find("sphere { <0, 0, 0>, 0.5 material { M1 } }\n"),
            std::string::npos);
  EXPECT_NE(text("tachyon", false, "balls", 1).find("SPHERE CENTER 0 0 0 RAD 0.5 M1\n"), std::string::npos);
  std::ostringstream out;
  EXPECT_EQ(makeWriter({.format = "vrml"}, out), nullptr);
}

}  // namespace
}  // namespace rayshade::spd
