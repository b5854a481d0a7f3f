// Maps with known images, and chains of them.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/transform.h"

#include <gtest/gtest.h>

#include "tests/support/near.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

Expression time() { return {{{Operation::time, 0}}}; }
MovingStep moving(MovingStep::Kind kind, std::vector<Expression> arguments) {
  return {kind, std::move(arguments)};
}
MovingStep translateByTime() {
  return moving(MovingStep::Kind::translate, {time(), constantExpression(0), constantExpression(0)});
}
MovingStep scaleByTime() { return moving(MovingStep::Kind::scale, {time(), time(), time()}); }

Affine randomMap(Random& random) {
  Affine map = rotation(random.point(-1, 1), random.real(-180, 180));
  map = then(map, scaling({random.real(0.1, 3), -random.real(0.1, 3), random.real(0.1, 3)}).value());
  map = then(map, translation(random.point(-10, 10)));
  return then(map, rotation(random.point(-1, 1), random.real(-180, 180)));
}

TEST(Transform, RotationsAreRightHandedAndInDegrees) {
  expectNear(mapPoint(rotation({0, 0, 1}, 90).forward, {1, 0, 0}), {0, 1, 0});
  expectNear(mapPoint(rotation({0, 0, 5}, 90).forward, {0, 1, 0}), {-1, 0, 0});
  expectNear(mapPoint(rotation({1, 0, 0}, 90).forward, {0, 1, 0}), {0, 0, 1});
  expectNear(mapPoint(rotation({0, 1, 0}, 90).forward, {0, 0, 1}), {1, 0, 0});
  expectNear(mapPoint(rotation({1, 1, 1}, 120).forward, {1, 0, 0}), {0, 1, 0});
  expectNear(mapPoint(rotation({0, 0, 1}, -180).forward, {1, 2, 3}), {-1, -2, 3});
}

TEST(Transform, AboutNoAxisNothingTurns) { EXPECT_TRUE(isIdentity(rotation({0, 0, 0}, 30))); }

TEST(Transform, WhatIsWrittenFirstIsAppliedFirst) {
  const Affine moved = translation({1, 0, 0}), turned = rotation({0, 0, 1}, 90);
  expectNear(mapPoint(then(moved, turned).forward, {0, 0, 0}), {0, 1, 0});
  expectNear(mapPoint(then(turned, moved).forward, {0, 0, 0}), {1, 0, 0});
}

TEST(Transform, EveryMapCarriesItsInverse) {
  SeededRandom random(1);
  for (int i = 0; i < 500; ++i) {
    const Affine map = randomMap(random);
    const Vec3 p = random.point(-5, 5);
    EXPECT_LT(length(mapPoint(map.inverse, mapPoint(map.forward, p)) - p), 1e-12);
    EXPECT_LT(length(mapVector(map.inverse, mapVector(map.forward, p)) - p), 1e-12);
    EXPECT_EQ(mapPoint(inverted(map).forward, p), mapPoint(map.inverse, p));
  }
}

TEST(Transform, TranslationsAndPowersOfTwoAreUndoneExactly) {
  const Affine map = then(scaling({2, -4, 0.5}).value(), translation({1, 2, 3}));
  EXPECT_EQ(mapPoint(map.inverse, mapPoint(map.forward, {0.125, 0.25, 0.75})), (Vec3{0.125, 0.25, 0.75}));
}

TEST(Transform, VectorsDoNotMove) {
  EXPECT_EQ(mapVector(translation({5, 6, 7}).forward, {1, 2, 3}), (Vec3{1, 2, 3}));
}

TEST(Transform, NormalsStayAtRightAnglesToTheSurface) {
  SeededRandom random(1);
  for (int i = 0; i < 500; ++i) {
    const Affine map = randomMap(random);
    const Vec3 along = random.point(-1, 1), across = cross(along, random.point(-1, 1));
    const Vec3 mapped = mapVector(map.forward, along), normal = mapNormal(map.inverse, across);
    EXPECT_LT(std::abs(dot(mapped, normal)), 1e-13 * length(mapped) * length(normal));
  }
}

TEST(Transform, AScaleOfNothingHasNoInverseAndIsRefused) {
  EXPECT_FALSE(scaling({1, 0, 1}));
  EXPECT_FALSE(scaling({-0.0, 1, 1}));
  EXPECT_FALSE(scaling({1, 1, kInfinity}));
  EXPECT_FALSE(scaling({1, 5e-324, 1})) << "its inverse is no number";
  EXPECT_TRUE(scaling({1e-200, 1, -1}));
}

TEST(Transform, MatricesAreRefusedWhenSingularHoweverSmallOrLarge) {
  for (const double scale : {1e-60, 1.0, 1e+60}) {
    const Matrix good{{scale, 0, 0}, {scale, 2 * scale, 0}, {0, scale, 3 * scale}, {scale, 0, 0}};
    const auto map = linearMap(good);
    ASSERT_TRUE(map) << scale;
    EXPECT_LT(length(mapPoint(map->inverse, mapPoint(map->forward, {1, 2, 3})) - Vec3{1, 2, 3}), 1e-14);
    EXPECT_FALSE(linearMap({{scale, 0, 0}, {2 * scale, 0, 0}, {0, 0, scale}, {}}));
    EXPECT_FALSE(linearMap({{scale, 0, 0}, {0, scale, 0}, {scale, scale, 0}, {}}));
  }
  EXPECT_FALSE(linearMap({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {}}));
  EXPECT_FALSE(linearMap({{std::nan(""), 0, 0}, {0, 1, 0}, {0, 0, 1}, {}}));
  EXPECT_FALSE(linearMap({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {kInfinity, 0, 0}}));
}

// The canonical cylinder, radius 1 about z from 0 to 1, to its place.
TEST(Transform, TheCanonicalCylinderGoesToItsPlace) {
  const Vec3 axes[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -3, 0}, {1, 2, -2}, {1e-9, 0, -1}};
  for (const Vec3& axis : axes) {
    const Affine map = alongAxis({4, 5, 6}, axis, 0.5, 3);
    const Vec3 along = normalize(axis);
    expectNear(mapPoint(map.forward, {0, 0, 0}), {4, 5, 6}, 1e-14);
    expectNear(mapPoint(map.forward, {0, 0, 1}), Vec3{4, 5, 6} + 3 * along, 1e-14);
    for (const Vec3& side : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) {
      const Vec3 image = mapVector(map.forward, side);
      EXPECT_NEAR(length(image), 0.5, 1e-15);
      EXPECT_NEAR(dot(image, along), 0, 1e-15);
    }
    expectNear(mapPoint(map.inverse, mapPoint(map.forward, {1, 2, 3})), {1, 2, 3}, 1e-13);
  }
}

TEST(Transform, BoundsHoldTheImageOfEveryCorner) {
  SeededRandom random(1);
  for (int i = 0; i < 300; ++i) {
    const Affine map = randomMap(random);
    const Vec3 low = random.point(-4, 4), size{random.real(0, 3), random.real(0, 3), random.real(0, 3)};
    const Bounds box{low, low + size}, image = padded(mapBounds(map, box));
    Bounds tight;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p{corner & 1 ? box.high.x : low.x, corner & 2 ? box.high.y : low.y,
                   corner & 4 ? box.high.z : low.z};
      const Vec3 q = mapPoint(map.forward, p);
      EXPECT_TRUE(contains(image, q));
      tight = join(tight, q);
    }
    EXPECT_LT(maxAbs(image.low - tight.low), 1e-6);
    EXPECT_LT(maxAbs(image.high - tight.high), 1e-6);
  }
}

TEST(Transform, UnboundedThingsStayUnboundedAndEmptyOnesEmpty) {
  const Affine turned = rotation({0, 0, 1}, 90);
  const Bounds slab{{-kInfinity, -kInfinity, -1}, {kInfinity, kInfinity, 2}};
  const Bounds image = mapBounds(then(turned, translation({0, 0, 3})), slab);
  EXPECT_EQ(image.low, (Vec3{-kInfinity, -kInfinity, 2}));
  EXPECT_EQ(image.high, (Vec3{kInfinity, kInfinity, 5}));
  EXPECT_TRUE(mapBounds(turned, Bounds{}).empty());
}

TEST(TransformChain, ConstantStepsSideBySideAreOne) {
  TransformChain chain;
  EXPECT_TRUE(chain.empty());
  chain.append(translation({1, 0, 0}));
  chain.append(rotation({0, 0, 1}, 90));
  EXPECT_EQ(chain.steps.size(), 1u);
  EXPECT_FALSE(chain.moves());
  chain.append(translateByTime());
  chain.append(translation({0, 0, 1}));
  EXPECT_EQ(chain.steps.size(), 3u);
  EXPECT_TRUE(chain.moves());
  expectNear(mapPoint(chainAt(chain, {7, 0})->forward, {0, 0, 0}), {7, 1, 1});
}

TEST(TransformChain, AStepWithoutAnInverseAtAMomentIsLeftOutThen) {
  TransformChain chain;
  chain.append(scaleByTime());
  chain.append(translation({1, 2, 3}));
  EXPECT_FALSE(stepAt(scaleByTime(), {0, 0}));
  EXPECT_EQ(mapPoint(chainAt(chain, {0, 0})->forward, {1, 1, 1}), (Vec3{2, 3, 4}));
  EXPECT_EQ(mapPoint(chainAt(chain, {2, 0})->forward, {1, 1, 1}), (Vec3{3, 4, 5}));
}

TEST(TransformChain, EveryKindOfStepMeansWhatTheConstantOneMeans) {
  auto constants = [](std::initializer_list<double> values) {
    std::vector<Expression> list;
    for (double v : values) list.push_back(constantExpression(v));
    return list;
  };
  using Kind = MovingStep::Kind;
  EXPECT_EQ(stepAt(moving(Kind::translate, constants({1, 2, 3})), {}), translation({1, 2, 3}));
  EXPECT_EQ(stepAt(moving(Kind::scale, constants({1, 2, 3})), {}), scaling({1, 2, 3}));
  EXPECT_EQ(stepAt(moving(Kind::rotate, constants({0, 1, 1, 30})), {}), rotation({0, 1, 1}, 30));
  const Matrix matrix{{1, 2, 0}, {0, 1, 0}, {0, 3, 1}, {}};
  EXPECT_EQ(stepAt(moving(Kind::transform, constants({1, 2, 0, 0, 1, 0, 0, 3, 1})), {}), linearMap(matrix));
  Matrix shifted = matrix;
  shifted.origin = {7, 8, 9};
  EXPECT_EQ(stepAt(moving(Kind::transform, constants({1, 2, 0, 0, 1, 0, 0, 3, 1, 7, 8, 9})), {}),
            linearMap(shifted));
}

TEST(TransformChain, SurvivesTheWire) {
  TransformChain chain;
  chain.append(rotation({1, 2, 3}, 45));
  chain.append(translateByTime());
  const Bytes bytes = encode(chain);
  const auto back = decode<TransformChain>(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(encode(*back), bytes);
  EXPECT_EQ(chainAt(*back, {0.5, 0}), chainAt(chain, {0.5, 0}));
}

TEST(TransformChain, StepsWithTheWrongNumberOfArgumentsAreRefused) {
  using Kind = MovingStep::Kind;
  for (const auto& [kind, right] : {std::pair{Kind::translate, 3u},
                                    {Kind::scale, 3u},
                                    {Kind::rotate, 4u},
                                    {Kind::transform, 9u},
                                    {Kind{4}, 99u}})
    for (std::size_t n = 0; n <= 13; ++n) {
      const bool good = n == right || (kind == Kind::transform && n == 12);
      const std::vector<Expression> arguments(n, constantExpression(1));
      EXPECT_EQ(decode<MovingStep>(encode(moving(kind, arguments))).has_value(), good)
          << static_cast<int>(kind) << " with " << n;
    }
}

}  // namespace
}  // namespace rayshade
