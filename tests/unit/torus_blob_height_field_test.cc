// Torus, blob and height field: known crossings, far origins, the way out from inside.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rayshade/shapes/blob.h"
#include "rayshade/shapes/height_field.h"
#include "rayshade/shapes/torus.h"
#include "tests/support/shape_subjects.h"

namespace rayshade {
namespace {

static_assert(Shape<Torus> && Shape<Blob> && Shape<HeightField>);

void expectNear(const std::vector<double>& found, const std::vector<double>& expected, double error) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], error);
}

constexpr Torus kRing{1, 0.25, {}, {0, 0, 1}};

TEST(Torus, LineThroughTheMiddleCrossesFourTimes) {
  expectNear(crossingsOfTheLine(kRing, rayFrom({-5, 0, 0}, {1, 0, 0})), {3.75, 4.25, 5.75, 6.25}, 1e-14);
}

TEST(Torus, LineAcrossTheTopTouchesTwice) {
  expectNear(crossingsOfTheLine(kRing, rayFrom({-5, 0, 0.25}, {1, 0, 0})), {4, 6}, 1e-7);
}

TEST(Torus, LineThroughTheHoleMisses) {
  EXPECT_TRUE(crossingsOfTheLine(kRing, rayFrom({0, 0, -5}, {0, 0, 1})).empty());
  EXPECT_TRUE(crossingsOfTheLine(kRing, rayFrom({0.5, 0, -5}, {0, 0.01, 1})).empty());
}

TEST(Torus, ThinTubeFromFarAway) {
  const Torus thin{1, 0.01, {}, {0, 0, 1}};
  for (const double distance : {500.0, 5000.0, 50000.0}) {
    const double z = 0.006, half = 0.008;  // 0.006^2 + 0.008^2 = 0.01^2
    expectNear(crossingsOfTheLine(thin, rayFrom({-distance, 0, z}, {1, 0, 0})),
               {distance - 1 - half, distance - 1 + half, distance + 1 - half, distance + 1 + half},
               1e-5 * 0.01);
  }
}

TEST(Torus, SpindleShowsItsInnerSheetWithNormalsIntoIt) {
  const Torus spindle{0.5, 1, {}, {0, 0, 1}};
  const LocalRay ray = rayFrom({-5, 0, 0}, {1, 0, 0});
  expectNear(crossingsOfTheLine(spindle, ray), {3.5, 4.5, 5.5, 6.5}, 1e-13);
  EXPECT_NEAR(spindle.pointAt(ray, 3.5).geometricNormal.x, -1, 1e-14);
  EXPECT_NEAR(spindle.pointAt(ray, 4.5).geometricNormal.x, 1, 1e-14);
  EXPECT_NEAR(spindle.pointAt(ray, 5.5).geometricNormal.x, -1, 1e-14);
}

TEST(Torus, BoundsAreTight) {
  const Bounds flat = Torus{1, 0.25, {1, 2, 3}, {0, 0, -7}}.bounds();
  EXPECT_NEAR(flat.low.x, -0.25, 1e-15);
  EXPECT_NEAR(flat.high.y, 3.25, 1e-15);
  EXPECT_NEAR(flat.high.z, 3.25, 1e-15);
  const Bounds oblique = Torus{1, 0.25, {}, {1, 1, 0}}.bounds();
  EXPECT_NEAR(oblique.high.x, std::sqrt(0.5) + 0.25, 1e-15);
  EXPECT_NEAR(oblique.high.z, 1.25, 1e-15);
}

TEST(Torus, VIsZeroInsideAndGoesRoundTheTube) {
  auto at = [](Vec3 p) {
    const LocalRay ray = rayFrom(p, {0, 1, 0});
    const ShapePoint point = kRing.pointAt(ray, 0);
    return kRing.coordinates(point, point.position);
  };
  EXPECT_NEAR(at({0.75, 0, 0}).v, 0, 1e-7);
  EXPECT_NEAR(at({1, 0, -0.25}).v, 0.25, 1e-12);
  EXPECT_NEAR(at({1.25, 0, 0}).v, 0.5, 1e-7);
  EXPECT_NEAR(at({1, 0, 0.25}).v, 0.75, 1e-12);
  EXPECT_NEAR(at({0, 1.25, 0}).u, 0.25, 1e-12);
  EXPECT_NEAR(at({0, -1.25, 0}).u, 0.75, 1e-12);
  EXPECT_NEAR(at({1.25, 0, 0}).dpdu.y, 1, 1e-12);
  EXPECT_NEAR(at({1.25, 0, 0}).dpdv.z, 1, 1e-12);
}

TEST(Torus, DegenerateOnesAreDropped) {
  EXPECT_TRUE(parsed<Torus>("1 0.25 0 0 0 0 0 1"));
  EXPECT_TRUE(parsed<Torus>("1e-9 1e-12 0 0 0 0 0 1e-20"));
  EXPECT_FALSE(parsed<Torus>("1 0  0 0 0 0 0 1"));
  EXPECT_FALSE(parsed<Torus>("0 1  0 0 0 0 0 1"));
  EXPECT_FALSE(parsed<Torus>("-1 1  0 0 0 0 0 1"));
  EXPECT_FALSE(parsed<Torus>("1 1  0 0 0 0 0 0"));
  EXPECT_FALSE(parsed<Torus>("1 inf  0 0 0 0 0 1"));
}

// One ball of radius 1: (1 - d^2)^2 = 1/4 at d = sqrt(1/2).
const Blob kBall{0.25, {{{}, 1, 1}}};
const double kSkin = std::sqrt(0.5);

TEST(Blob, OneBallIsASphere) {
  expectNear(crossingsOfTheLine(kBall, rayFrom({-5, 0, 0}, {1, 0, 0})), {5 - kSkin, 5 + kSkin}, 1e-14);
  const double half = std::sqrt(kSkin * kSkin - 0.09);
  expectNear(crossingsOfTheLine(kBall, rayFrom({-5, 0.3, 0}, {1, 0, 0})), {5 - half, 5 + half}, 1e-14);
  EXPECT_TRUE(crossingsOfTheLine(kBall, rayFrom({-5, 0.71, 0}, {1, 0, 0})).empty());
  const LocalRay ray = rayFrom({-5, 0, 0}, {1, 0, 0});
  EXPECT_NEAR(kBall.pointAt(ray, 5 - kSkin).geometricNormal.x, -1, 1e-15);
}

TEST(Blob, ABallThatJustReachesTheThresholdIsTouchedOnce) {
  const Blob point{1, {{{}, 1, 1}}};
  expectNear(crossingsOfTheLine(point, rayFrom({-5, 0, 0}, {1, 0, 0})), {5}, 1e-7);
}

TEST(Blob, BallsInARowMergeAtOneThresholdAndNotAtAnother) {
  const std::vector<Metaball> balls{{{-0.5, 0, 0}, 1, 1}, {{0.5, 0, 0}, 1, 1}};
  // In the middle both give (1 - 1/4)^2 = 0.5625.
  EXPECT_EQ(crossingsOfTheLine(Blob{1.1, balls}, rayFrom({-5, 0, 0}, {1, 0, 0})).size(), 2u);
  EXPECT_EQ(crossingsOfTheLine(Blob{1.13, balls}, rayFrom({-5, 0, 0}, {1, 0, 0})).size(), 0u);
  const std::vector<Metaball> apart{{{-0.7, 0, 0}, 1, 1}, {{0.7, 0, 0}, 1, 1}};
  EXPECT_EQ(crossingsOfTheLine(Blob{0.5, apart}, rayFrom({-5, 0, 0}, {1, 0, 0})).size(), 2u);
  EXPECT_EQ(crossingsOfTheLine(Blob{0.6, apart}, rayFrom({-5, 0, 0}, {1, 0, 0})).size(), 4u);
}

TEST(Blob, ARayThatGoesInFindsTheWayOut) {
  for (int i = 0; i < 500; ++i) {
    const LocalRay arriving = rayFrom({-5, -0.6 + 0.0024 * i, 0.1}, {1, 0, 0});
    const double t = kBall.intersect(arriving, 0);
    ASSERT_NE(t, kNoHit);
    const ShapePoint at = kBall.pointAt(arriving, t);
    const Vec3 inward = normalize({1, 0.3, -0.2});
    const LocalRay inside{at.position, normalize(inward - 1.5 * at.geometricNormal), 1};
    const double chord = -2 * dot(at.position, inside.direction);
    EXPECT_NEAR(kBall.intersect(inside, 1e-12), chord, 1e-13);
  }
}

TEST(Blob, SizeMakesNoDifference) {
  const std::vector<Metaball> balls{
      {{-0.3, 0.1, 0}, 0.9, 1}, {{0.5, 0, 0.2}, 0.8, 0.7}, {{0, 0.6, 0}, 0.7, 1.2}};
  const Blob unit{0.4, balls};
  for (const double scale : {1e7, 1e-7}) {
    Blob scaled = unit;
    for (Metaball& ball : scaled.balls) ball = {scale * ball.centre, scale * ball.radius, ball.strength};
    for (int y = -20; y <= 20; ++y) {
      for (int x = -20; x <= 20; ++x) {
        const Vec3 origin{0.061 * x, 0.061 * y, -4};
        const auto plain = crossingsOfTheLine(unit, rayFrom(origin, {0.01, 0.02, 1}));
        const auto large = crossingsOfTheLine(scaled, rayFrom(scale * origin, {0.01, 0.02, 1}));
        ASSERT_EQ(large.size(), plain.size());
        for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(large[i] / scale, plain[i], 1e-12);
        if (plain.empty()) continue;
        // Nothing of what is left behind is met again.
        const LocalRay ray = rayFrom(scale * origin, {0.01, 0.02, 1});
        const ShapePoint at = scaled.pointAt(ray, large[0]);
        const LocalRay away{at.position, at.geometricNormal, 1};
        const double again = scaled.intersect(away, 4 * at.error);
        EXPECT_TRUE(again == kNoHit || again > 0.01 * scale);
      }
    }
  }
}

TEST(Blob, ThousandsOfOverlappingBallsAreStillQuick) {
  Blob many{3000, {}};
  for (int i = 0; i < 20000; ++i) many.balls.push_back({{1e-5 * i, 0, 0}, 1, 1});
  EXPECT_EQ(crossingsOfTheLine(many, rayFrom({-5, 0.1, 0}, {1, 0, 0})).size(), 2u);
}

TEST(Blob, DegenerateOnesAreDropped) {
  EXPECT_TRUE(parsed<Blob>("0.5 1 1 0 0 0"));
  EXPECT_EQ(parsed<Blob>("0.5 1 1 0 0 0 2 3 4 5 6")->balls.size(), 2u);
  EXPECT_FALSE(parsed<Blob>("0.5 0 1 0 0 0"));
  EXPECT_FALSE(parsed<Blob>("0.5 1 1 0 0 0  1 0 0 0 0"));
  EXPECT_FALSE(parsed<Blob>("0 1 1 0 0 0"));
  EXPECT_FALSE(parsed<Blob>("0.5 1 inf 0 0 0"));
}

HeightField fieldOf(std::int32_t size, std::vector<float> values) {
  return {makeHeights(size, std::move(values))};
}

const LocalRay down(double x, double y) { return {{x, y, 10}, {0, 0, -1}, 1}; }

TEST(HeightField, CellsAreCutFromTheRightToTheUpperCorner) {
  const HeightField cell =
      fieldOf(2, {0, 0, 0, 1});  // flat below the diagonal, rising to 1 at (1, 1) above it
  EXPECT_DOUBLE_EQ(cell.intersect(down(0.25, 0.25), 0), 10);
  EXPECT_DOUBLE_EQ(cell.intersect(down(0.75, 0.75), 0), 9.5);
  EXPECT_DOUBLE_EQ(cell.intersect(down(1, 1), 0), 9);
  EXPECT_EQ(cell.intersect(down(1.001, 0.5), 0), kNoHit);
  EXPECT_EQ(cell.intersect(down(0.5, 0.5), 20), kNoHit);
}

TEST(HeightField, NormalsPointUpAndCoordinatesAreXAndY) {
  const HeightField cell = fieldOf(2, {0, 0, 0, 1});
  const LocalRay up{{0.75, 0.6, -10}, {0, 0, 1}, 1};
  const ShapePoint at = cell.pointAt(up, cell.intersect(up, 0));
  EXPECT_NEAR(at.position.z, 0.35, 1e-15);
  EXPECT_NEAR(at.geometricNormal.x, -1 / std::sqrt(3), 1e-15);
  EXPECT_NEAR(at.geometricNormal.z, 1 / std::sqrt(3), 1e-15);
  const SurfaceCoordinates c = cell.coordinates(at, at.position);
  EXPECT_NEAR(c.u, 0.75, 1e-15);
  EXPECT_NEAR(c.v, 0.6, 1e-15);
  EXPECT_NEAR(dot(c.dpdu, at.normal), 0, 1e-15);
  EXPECT_NEAR(dot(c.dpdv, at.normal), 0, 1e-15);
}

TEST(HeightField, TrianglesThatTouchAHoleVanish) {
  const HeightField field = fieldOf(3, {0, 0, 0, 0, -1000, 0, 0, 0, std::nanf("")});
  EXPECT_DOUBLE_EQ(field.intersect(down(0.1, 0.1), 0),
                   10);  // the triangle at (0, 0) does not touch the middle
  EXPECT_EQ(field.intersect(down(0.4, 0.4), 0), kNoHit);
  EXPECT_EQ(field.intersect(down(0.55, 0.55), 0), kNoHit);
  EXPECT_EQ(field.intersect(down(0.95, 0.95), 0), kNoHit);
  EXPECT_EQ(field.intersect(down(0.95, 0.1), 0), kNoHit);
  EXPECT_EQ(field.bounds(), (Bounds{{0, 0, 0}, {1, 1, 0}}));
}

std::vector<float> bumps(int size) {
  std::vector<float> values;
  for (int i = 0; i < size * size; ++i)
    values.push_back(static_cast<float>(0.1 * std::sin(12.9898 * i) * std::sin(0.37 * (i % size))));
  return values;
}

TEST(HeightField, NoCracksAlongLinesDiagonalsAndCorners) {
  const int size = 33;
  const HeightField field = fieldOf(size, bumps(size));
  for (const Vec3 direction :
       {Vec3{0, 0, -1}, Vec3{0.3, 0.2, -1}, Vec3{1, 0.1, -0.6}, Vec3{-0.1, -1, -0.7}}) {
    for (const double distance : {3.0, 777.7, 1e6}) {
      // Away from the border, so that the ray comes in above all heights and leaves below.
      for (int i = 20; i <= 44; ++i) {
        for (int j = 20; j <= 44; ++j) {
          // Corners, middles of lines and middles of diagonals, at height 0 or where the surface really is.
          const Vec3 target{i / 64.0, j / 64.0,
                            i % 2 + j % 2 == 0
                                ? field.heights->values[static_cast<std::size_t>(j / 2 * size + i / 2)]
                                : 0.0};
          const Vec3 d = normalize(direction);
          EXPECT_NE(field.intersect({target - distance * d, d, 1}, 0), kNoHit) << i << " " << j;
        }
      }
    }
  }
}

TEST(HeightField, ARayThroughASharedEdgeHitsOnce) {
  const int size = 17;
  const HeightField field = fieldOf(size, bumps(size));
  for (int i = 0; i <= 64; ++i) {
    for (int j = 0; j <= 64; ++j) {
      const double x = i / 64.0, y = j / 64.0;  // of these, most lie on lines or diagonals
      EXPECT_EQ(crossingsOfTheLine(field, down(x, y)).size(), 1u) << x << " " << y;
    }
  }
}

TEST(HeightField, ARayInThePlaneOfAFlatFieldMisses) {
  const HeightField flat = fieldOf(3, std::vector<float>(9, 0.5f));
  EXPECT_EQ(flat.intersect(rayFrom({-1, 0.5, 0.5}, {1, 0, 0}), 0), kNoHit);
  EXPECT_EQ(flat.intersect(rayFrom({-1, 0.5, 0.5}, {1, 0.1, 0}), 0), kNoHit);
}

TEST(HeightField, TheQuadtreeLosesNothing) {
  const int size = 14;
  const HeightField field = fieldOf(size, bumps(size));
  for (int i = 0; i < 400; ++i) {
    const double angle = 0.1 * i;
    const LocalRay ray =
        rayFrom({0.5 + 2 * std::cos(angle), 0.5 + 2 * std::sin(angle), 0.02 + 0.001 * (i % 50)},
                {-std::cos(angle + 0.1), -std::sin(angle + 0.1), -0.01});
    std::vector<double> one = crossingsOfTheLine(field, ray), cellByCell;
    // Each cell alone, as a field of its own in a transformed space.
    const double cells = size - 1;
    for (int y = 0; y + 1 < size; ++y) {
      for (int x = 0; x + 1 < size; ++x) {
        auto z = [&](int dx, int dy) {
          return field.heights->values[static_cast<std::size_t>((y + dy) * size + x + dx)];
        };
        const HeightField cell = fieldOf(2, {z(0, 0), z(1, 0), z(0, 1), z(1, 1)});
        Vec3 o = ray.origin, d = ray.direction;
        o.x = o.x * cells - x, o.y = o.y * cells - y, d.x *= cells, d.y *= cells;
        const double stretch = length(d);
        for (const double t : crossingsOfTheLine(cell, {o, d / stretch, 1}))
          cellByCell.push_back(t / stretch);
      }
    }
    std::sort(cellByCell.begin(), cellByCell.end());
    expectNear(one, cellByCell, 1e-12);
  }
}

TEST(QuarticShapes, ScalingByAPowerOfTwoKeepsTheBits) {
  const Torus torus{0.9, 0.3, {0.1, 0.2, 0.3}, {1, -2, 0.4}};
  const Blob blob{0.45, {{{-0.5, 0.1, 0}, 0.9, 1}, {{0.4, 0, 0.3}, 0.7, 0.8}}};
  int hits = 0;
  for (const double scale : {0x1p-20, 0x1p20}) {
    const Torus scaledTorus{scale * torus.swept, scale * torus.tube, scale * torus.centre, torus.axis};
    Blob scaledBlob = blob;
    for (Metaball& ball : scaledBlob.balls) ball = {scale * ball.centre, scale * ball.radius, ball.strength};
    for (int i = 0; i < 200; ++i) {
      const LocalRay ray = rayFrom({0.01 * i - 1, 0.3, -7}, {0, 0.003 * (i % 40) - 0.06, 1});
      const LocalRay scaledRay{scale * ray.origin, ray.direction, 1};
      const double tTorus = torus.intersect(ray, 0), tBlob = blob.intersect(ray, 0);
      EXPECT_EQ(scaledTorus.intersect(scaledRay, 0), scale * tTorus);
      EXPECT_EQ(scaledBlob.intersect(scaledRay, 0), scale * tBlob);
      if (tTorus == kNoHit || tBlob == kNoHit) continue;
      ++hits;
      EXPECT_EQ(scaledTorus.pointAt(scaledRay, scale * tTorus).position,
                scale * torus.pointAt(ray, tTorus).position);
      EXPECT_EQ(scaledBlob.pointAt(scaledRay, scale * tBlob).error, scale * blob.pointAt(ray, tBlob).error);
    }
  }
  EXPECT_GT(hits, 50);
}

TEST(HeightField, ComesBackFromTheWireWithItsQuadtree) {
  const HeightField field = fieldOf(6, bumps(6));
  const Bytes bytes = encode(field);
  const auto back = decode<HeightField>(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(encode(*back), bytes);
  EXPECT_EQ(back->bounds(), field.bounds());
  const LocalRay ray = rayFrom({-1, 0.3, 0.4}, {1, 0.1, -0.3});
  EXPECT_EQ(back->intersect(ray, 0), field.intersect(ray, 0));
}

TEST(HeightField, AMessageWithTheWrongNumberOfHeightsIsRefused) {
  Bytes bytes;
  Writer{bytes}(std::int32_t{3}, std::vector<float>(8, 0.0f));
  EXPECT_FALSE(decode<HeightField>(bytes));
  EXPECT_EQ(HeightField{}.intersect(down(0.5, 0.5), 0), kNoHit);
}

TEST(QuarticShapes, RaysThatAreNoNumbersHitNothing) {
  const double nan = std::nan("");
  for (const LocalRay& ray : {LocalRay{{nan, 0, 0}, {1, 0, 0}, 1}, LocalRay{{0, 0, 0}, {nan, nan, nan}, 1},
                              LocalRay{{kInfinity, 0, 0}, {1, 0, 0}, 1}}) {
    EXPECT_EQ(kRing.intersect(ray, 0), kNoHit);
    EXPECT_EQ(kBall.intersect(ray, 0), kNoHit);
    EXPECT_EQ(fieldOf(6, bumps(6)).intersect(ray, 0), kNoHit);
  }
}

}  // namespace
}  // namespace rayshade
