// Known values of sphere, box, plane, disc, cylinder and cone, and the hard numerical cases.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>

#include "rayshade/base/transform.h"
#include "rayshade/shapes/box.h"
#include "rayshade/shapes/cone.h"
#include "rayshade/shapes/cylinder.h"
#include "rayshade/shapes/disc.h"
#include "rayshade/shapes/plane.h"
#include "rayshade/shapes/sphere.h"
#include "tests/support/near.h"
#include "tests/support/shape_subjects.h"

namespace rayshade {
namespace {

TEST(Sphere, SeenFromTenToTheEighthRadii) {
  const Sphere sphere;
  const LocalRay ray = rayTo({0, 0, -1e8}, {0.5, 0, 0});
  EXPECT_NEAR(sphere.intersect(ray, 0), 99999999.133974595, 1.5e-8);
}
TEST(Sphere, NearTangentsFromFarAway) {
  const Sphere sphere;
  EXPECT_NEAR(sphere.intersect({{0.999999, 0, -1e7}, {0, 0, 1}}, 0), 9999999.998585787, 4e-9);
  EXPECT_EQ(sphere.intersect({{1.000001, 0, -1e7}, {0, 0, 1}}, 0), kNoHit);
}
TEST(Sphere, ExactTangencyIsAHit) {
  const Sphere sphere;
  const LocalRay ray{{-5, 1, 0}, {1, 0, 0}};
  EXPECT_EQ(sphere.intersect(ray, 0), 5);
  EXPECT_EQ(sphere.pointAt(ray, 5).normal, (Vec3{0, 1, 0}));
}
TEST(Sphere, FromItsCentre) { EXPECT_EQ(Sphere{}.intersect({{0, 0, 0}, {0, 1, 0}}, 0), 1); }
TEST(Sphere, FromItsSurfaceTheOriginIsNotHitAgain) {
  const Sphere sphere;
  EXPECT_EQ(sphere.intersect({{1, 0, 0}, {1, 0, 0}}, 0), kNoHit);
  EXPECT_EQ(sphere.intersect({{1, 0, 0}, {-1, 0, 0}}, 0), 2);
  EXPECT_EQ(sphere.intersect({{1, 0, 0}, {0, 1, 0}}, 0), kNoHit);
}
TEST(Sphere, AsGround) {
  const Sphere ground{{0, -1e8, 0}, 1e8};
  EXPECT_NEAR(ground.intersect(rayFrom({0, 1, 0}, {1, -0.001, 0}), 0), 1005.05113640866673, 1e-4);
  EXPECT_NEAR(ground.intersect({{0, 1, 0}, {0, -1, 0}}, 0), 1, 1.5e-8);
}
TEST(Sphere, OfAMicrometre) {
  EXPECT_NEAR((made<Sphere>("1e-6 0 0 0").intersect({{0, 0, -1}, {0, 0, 1}}, 0)), 0.999999, 1e-15);
}
TEST(Cylinder, ParallelToTheAxisIsAMiss) {
  for (const char* text : {"1 0 0 0 0 0 1", "1 0 0 0 1 1 1", "0.1 3 2 1 -4 0.3 7"}) {
    const Cylinder cylinder = made<Cylinder>(text);
    const Vec3 axis = cylinder.side.axis, beside = basisAround(axis).first;
    for (const double distance : {0.0, 0.05, 2.0})
      for (const double sign : {1.0, -1.0})
        EXPECT_TRUE(
            crossings(cylinder, {cylinder.side.base + distance * beside - axis, sign * axis}, -1e9).empty())
            << text;
  }
}
TEST(Cylinder, NearlyParallelToTheAxis) {
  const Cylinder cylinder = made<Cylinder>("1 0 0 0 0 0 4e9");
  EXPECT_NEAR(cylinder.intersect(rayFrom({0, 0, 0}, {1e-9, 0, 1}), 0), 1e9, 1.2e-7);
}
TEST(Cone, ThroughTheApexIsOneHit) {
  const Cone cone = made<Cone>("1 0 0 1  0 0 0 0");  // apex at the origin, opening to +z
  const LocalRay across{{-5, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(crossings(cone, across), Crossings{5});
  EXPECT_NEAR(length(cone.pointAt(across, 5).normal), 1, 1e-15);
  EXPECT_EQ(crossings(cone, {{0, 0, -3}, {0, 0, 1}}), Crossings{3});  // along the axis
  const Crossings steep =
      crossings(cone, rayFrom({-1, -2, -5}, {1, 2, 5}));  // from the mirrored nappe into the cone
  ASSERT_EQ(steep.size(), 1u);
  EXPECT_NEAR(steep[0], std::sqrt(30.0), 1e-14);
}
TEST(Cone, TheMirroredNappeIsNotThere) {
  const Cone cone = made<Cone>("1 0 0 1  0 0 0 0");
  EXPECT_TRUE(crossings(cone, {{-5, 0, -0.5}, {1, 0, 0}}, -1e9).empty());
}
TEST(Cone, ParallelToAGeneratorIsASingleHit) {
  const Cone cone = made<Cone>("0 0 0 0  1 0 0 1");
  // From (-1, 0, 0) along (1, 0, 1): x^2 = z^2 at t (1, 1) / sqrt 2 with x = t/sqrt 2 - 1: z = 1/2.
  const Crossings hits = crossings(cone, rayFrom({-1, 0, 0}, {1, 0, 1}), -1e9);
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_NEAR(hits[0], std::sqrt(0.5), 1e-15);
}
TEST(Cone, BesideAGeneratorIsNoHit) {
  // The exact ray stays outside by 5e-16 where it comes nearest: ninety roundings of the largest number in play.
  const double size = 0x1.ffdf9c552706dp-6;
  const Cone cone{{{0, 0, 0}, {0, -1, 0}, size, 0, size}};
  const LocalRay beside{{0x1.46e4001ad95f6p-7, -0x1.66582d7b94p-6, -0x1.3ee610194e3c5p-6},
                        {0x1.4ab30dabde491p-2, -0x1.6a09e3a996078p-1, -0x1.4212e17d56462p-1}};
  EXPECT_TRUE(crossings(cone, beside, -1e9).empty());
}
TEST(Sphere, UnderAStrongScaleAgreesWithTheExactEllipsoid) {
  const Affine place = *scaling({1e6, 1, 1e-6});
  const Vec3 origin{3e6, 0.25, 2e-6}, target{1e5, 0.125, -2.5e-7};  // world
  const Vec3 direction = normalize(target - origin);
  const Vec3 local = mapVector(place.inverse, direction);
  const LocalRay ray{mapPoint(place.inverse, origin), normalize(local), length(local)};
  const double t = Sphere{}.intersect(ray, 0) / ray.scale;
  const long double p[3] = {3, 0.25L, 2}, d[3] = {direction.x / 1e6L, direction.y, direction.z * 1e6L};
  const long double a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], b = p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
  const long double c = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 1;
  const long double exact = c / (-b + std::sqrt(b * b - a * c));
  EXPECT_LT(std::abs(t - exact), 1e-12L * exact);
}
TEST(Sphere, UnderAMirrorTheNormalIsOutward) {
  const Affine mirror = *scaling({-2, 1, 1});
  const LocalRay ray = rayTo(mapPoint(mirror.inverse, {-9, 1, 2}), {0, 0, 0});
  const ShapePoint at = Sphere{}.pointAt(ray, Sphere{}.intersect(ray, 0));
  EXPECT_GT(dot(mapNormal(mirror.inverse, at.geometricNormal), mapPoint(mirror.forward, at.position)), 0);
}

TEST(Plane, AGrazingRayHits) {
  const Plane plane;
  const double down = -9e-6;
  EXPECT_NEAR(plane.intersect({{0, 0, 1}, {std::sqrt(1 - down * down), 0, down}}, 0), 111111.11, 0.01);
  EXPECT_NEAR(plane.intersect(rayFrom({0, 0, 1}, {1, 0, -1e-12}), 0), 1e12, 1);
  EXPECT_EQ(plane.intersect({{0, 0, 1}, {1, 0, 0}}, 0), kNoHit);
  EXPECT_EQ(plane.intersect({{0, 0, 0}, {1, 0, 0}}, -1), kNoHit);
}
TEST(Plane, CoordinatesMirrorWhenSeenFromTheBack) {
  const Plane plane = made<Plane>("1 1 0  0 0 2");
  ShapePoint at;
  at.normal = {0, 0, 1};  // level: axes y, -x
  const SurfaceCoordinates front = plane.coordinates(at, {4, 3, 0});
  at.normal = {0, 0, -1};
  const SurfaceCoordinates back = plane.coordinates(at, {4, 3, 0});
  EXPECT_EQ(front.u, 3);
  EXPECT_EQ(front.v, 2);
  EXPECT_EQ(back.u, -3);
  EXPECT_EQ(back.v, 2);
}

TEST(Box, KnownHitsAndNormals) {
  const Box box = made<Box>("2 3 4  1 1 1");
  const LocalRay ray{{0, 2, 2}, {1, 0, 0}};
  EXPECT_EQ(crossings(box, ray), (Crossings{1, 2}));
  EXPECT_EQ(box.pointAt(ray, 1).normal, (Vec3{-1, 0, 0}));
  EXPECT_EQ(box.pointAt(ray, 2).normal, (Vec3{1, 0, 0}));
  EXPECT_EQ(crossings(box, {{1.5, 2, 2}, {0, 0, -1}}), Crossings{1});
  EXPECT_EQ(box.pointAt({{1.5, 2, 2}, {0, 0, -1}}, 1).normal, (Vec3{0, 0, -1}));
  EXPECT_TRUE(crossings(box, {{0, 2, 2}, {-1, 0, 0}}).empty());
}
TEST(Box, DirectionsOfZeroAndOriginsOnAFaceAreExact) {
  const Box box;
  for (const double zero : {0.0, -0.0}) {
    EXPECT_EQ(crossings(box, {{-1, 0, 0.5}, {1, zero, zero}}), (Crossings{1, 2}));  // along a face
    EXPECT_EQ(crossings(box, {{-1, 1, 1}, {1, zero, zero}}), (Crossings{1, 2}));    // along an edge
    EXPECT_TRUE(crossings(box, {{-1, -1e-300, 0.5}, {1, zero, zero}}).empty());
    EXPECT_EQ(crossings(box, {{0, 0.5, 0.5}, {1, zero, zero}}), Crossings{1});  // from the face inward
    EXPECT_TRUE(crossings(box, {{1, 0.5, 0.5}, {1, zero, zero}}).empty());
  }
}
TEST(Box, ATouchedEdgeIsAHit) {
  for (int i = 1; i < 1024; ++i) {  // in the plane x + y = 2, exactly through the edge x = y = 1
    const double s = i / 1024.0;
    const LocalRay ray{{1 - s, 1 + s, 0.5}, {std::sqrt(0.5), -std::sqrt(0.5), 0}};
    EXPECT_NE(Box{}.intersect(ray, 0), kNoHit) << i;
  }
  const LocalRay beside{{0.5 + 1e-12, 1.5, 0.5}, {std::sqrt(0.5), -std::sqrt(0.5), 0}};
  EXPECT_EQ(Box{}.intersect(beside, 0), kNoHit);
}
TEST(Box, OnlyAZeroSideIsDegenerate) {
  EXPECT_TRUE(refused<Box>("0 0 0  1 1 0"));
  EXPECT_TRUE(refused<Box>("0 0 0  1 1 nan"));
  EXPECT_TRUE(refused<Box>("0 0 0  1 1 inf"));
  EXPECT_FALSE(refused<Box>("0 0 0  1 1 1e-9"));
}

TEST(Disc, EndsAtItsRimAndHasRayshadesCoordinates) {
  const Disc disc = made<Disc>("2  0 0 1  0 0 -5");
  EXPECT_EQ(disc.intersect({{2, 0, 0}, {0, 0, 1}}, 0), 1);
  EXPECT_EQ(disc.intersect({{2.0000001, 0, 0}, {0, 0, 1}}, 0), kNoHit);
  EXPECT_EQ(disc.pointAt({{1, 1, 0}, {0, 0, 1}}, 1).normal, (Vec3{0, 0, -1}));
  auto uAt = [&](Vec3 p) { return disc.coordinates({}, p).u; };
  EXPECT_NEAR(uAt({0, 1, 1}), 0.25, 1e-15);
  EXPECT_NEAR(uAt({0, -1, 1}), 0.75, 1e-15);
  EXPECT_EQ(disc.coordinates({}, {0, -1, 1}).v, 0.5);
  EXPECT_EQ(disc.coordinates({}, {0, 0, 1}).u, 0);
  EXPECT_EQ(made<Disc>("1  5 0 0  0 0 1").coordinates({}, {5.5, 0, 0}).u, 0.5);  // not about its own centre
  EXPECT_TRUE(refused<Disc>("1  0 0 0  0 0 0"));
  EXPECT_TRUE(refused<Disc>("0  0 0 0  0 0 1"));
  EXPECT_FALSE(refused<Disc>("1e-9  0 0 0  0 0 1e-9"));
}

TEST(Cylinder, IsOpenAndEndsAtItsEnds) {
  const Cylinder cylinder = made<Cylinder>("1  0 0 0  0 0 2");
  const LocalRay across{{-3, 0, 1}, {1, 0, 0}};
  EXPECT_EQ(crossings(cylinder, across), (Crossings{2, 4}));
  EXPECT_EQ(cylinder.pointAt(across, 2).normal, (Vec3{-1, 0, 0}));
  EXPECT_EQ(cylinder.pointAt(across, 4).normal, (Vec3{1, 0, 0}));
  EXPECT_EQ(crossings(cylinder, {{-3, 0, 2}, {1, 0, 0}}), (Crossings{2, 4}));
  EXPECT_TRUE(crossings(cylinder, {{-3, 0, 2.0000001}, {1, 0, 0}}).empty());
  const Crossings inThroughTheTop = crossings(cylinder, rayFrom({0, 0, 3}, {1, 0, -2}));
  ASSERT_EQ(inThroughTheTop.size(), 1u);
  EXPECT_NEAR(inThroughTheTop[0], std::sqrt(5.0), 1e-14);
  EXPECT_EQ(crossings(cylinder, {{-3, 1, 1}, {1, 0, 0}}), Crossings{3});  // tangent
}
TEST(Cylinder, CoordinatesGoAroundAndAlongTheAxis) {
  const Cylinder cylinder = made<Cylinder>("2  0 0 1  0 0 5");
  auto at = [&](Vec3 p) { return cylinder.coordinates({}, p); };
  EXPECT_NEAR(at({2, 0, 2}).u, 0, 1e-15);
  EXPECT_NEAR(at({0, 2, 2}).u, 0.25, 1e-15);
  EXPECT_NEAR(at({0, -2, 2}).u, 0.75, 1e-15);
  EXPECT_NEAR(at({0, -2, 2}).v, 0.25, 1e-15);
  expectNear(at({0, 2, 2}).dpdu, {-1, 0, 0});
  expectNear(at({0, 2, 2}).dpdv, {0, 0, 1});
}
TEST(Cylinder, OnlyZeroSizesAreDegenerate) {
  EXPECT_TRUE(refused<Cylinder>("0  0 0 0  0 0 1"));
  EXPECT_TRUE(refused<Cylinder>("-1  0 0 0  0 0 1"));
  EXPECT_TRUE(refused<Cylinder>("1  1 2 3  1 2 3"));
  EXPECT_FALSE(refused<Cylinder>("1e-8  0 0 0  0 0 1e-8"));
}

TEST(Cone, KnownHitsNormalsAndCoordinates) {
  const Cone cone = made<Cone>("3  0 0 0  1  0 0 2");  // R = 3 - z
  const LocalRay across{{-5, 0, 1}, {1, 0, 0}};
  EXPECT_EQ(crossings(cone, across), (Crossings{3, 7}));
  expectNear(cone.pointAt(across, 3).normal, normalize({-1, 0, 1}));
  const SurfaceCoordinates c = cone.coordinates({}, {-2, 0, 1});
  EXPECT_NEAR(c.v, 0.5, 1e-15);  // from the small end
  EXPECT_NEAR(c.u, 0.5, 1e-15);
  expectNear(c.dpdv, normalize({-1, 0, -1}));
  EXPECT_NEAR(cone.coordinates({}, {0, 0.0, 2}).v, 0, 1e-15);
}
TEST(Cone, OfEqualRadiiIsACylinder) {
  const Cone cone = made<Cone>("0.25  1 2 3  0.25  -4 1e2 6");
  const Cylinder cylinder = made<Cylinder>("0.25  1 2 3  -4 1e2 6");
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const LocalRay ray = rayTo({-9, 40, -5}, {-1.5 + 0.005 * i, 51, 4.5});
    EXPECT_EQ(crossings(cone, ray), crossings(cylinder, ray));
    hits += !crossings(cone, ray).empty();
  }
  EXPECT_GT(hits, 10);
  EXPECT_TRUE(refused<Cone>("0  0 0 0  0  0 0 1"));
  EXPECT_TRUE(refused<Cone>("1  0 0 0  2  0 0 0"));
}

}  // namespace
}  // namespace rayshade
