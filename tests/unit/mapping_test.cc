// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/textures/mapping.h"

#include <gtest/gtest.h>

#include "rayshade/textures/apply.h"
#include "tests/support/text_arguments.h"

namespace rayshade {
namespace {

constexpr double kClose = 1e-12;

void expectNear(Vec3 a, Vec3 b) {
  EXPECT_NEAR(a.x, b.x, kClose);
  EXPECT_NEAR(a.y, b.y, kClose);
  EXPECT_NEAR(a.z, b.z, kClose);
}

Mapping mapping(const std::string& text) {
  TextArguments in(text);
  const Mapping parsed = parseMapping(in);
  EXPECT_TRUE(in.allTaken()) << text;
  return parsed;
}

void expectUv(const std::string& text, Vec3 position, double u, double v) {
  const MappedCoordinates at = coordinatesOf(mapping(text), position);
  EXPECT_NEAR(at.u, u, kClose) << text;
  EXPECT_NEAR(at.v, v, kClose) << text;
}

TEST(Spherical, RunsAroundTheAxisAndFromPoleToPole) {
  expectUv("spherical", {2, 2, 0}, 0.125, 0.5);
  expectUv("spherical", {0, 1, 1}, 0.25, 0.75);
  expectUv("spherical", {-3, 0, 0}, 0.5, 0.5);
  expectUv("spherical", {0, -1, -1}, 0.75, 0.25);
  expectUv("spherical", {0, 0, 5}, 0, 1);
  expectUv("spherical", {0, 0, -5}, 0, 0);
}

TEST(Spherical, HasUpAndAcrossOfItsOwn) {
  // up = y, across = z: then x is a quarter turn on
  expectUv("spherical 1 2 3  0 9 0  0 1 7", {2, 2, 3}, 0.25, 0.5);
  expectUv("spherical 1 2 3  0 9 0  0 1 7", {1, 2, 8}, 0, 0.5);
  expectUv("spherical 1 2 3  0 9 0  0 1 7", {1, 5, 3}, 0, 1);
}

TEST(Spherical, HasTangentsEverywhere) {
  for (Vec3 p : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 2, -3}}) {
    const MappedCoordinates at = coordinatesOf(mapping("spherical"), p);
    EXPECT_NEAR(length(at.dpdu), 1, kClose);
    EXPECT_NEAR(dot(at.dpdu, p), 0, kClose);
    expectNear(at.dpdv, cross(normalize(p), at.dpdu));
  }
  expectNear(coordinatesOf(mapping("spherical"), {1, 0, 0}).dpdu, {0, 1, 0});
  expectNear(coordinatesOf(mapping("spherical"), {1, 0, 0}).dpdv, {0, 0, 1});
}

TEST(Spherical, IsFiniteAtItsOrigin) {
  const MappedCoordinates at = coordinatesOf(mapping("spherical 1 2 3 0 0 1 1 0 0"), {1, 2, 3});
  EXPECT_TRUE(std::isfinite(at.u) && std::isfinite(at.v) && isFinite(at.dpdu) && isFinite(at.dpdv));
}

TEST(Cylindrical, RunsAroundAndAlongTheAxis) {
  expectUv("cylindrical", {0, 3, -7}, 0.25, -7);
  expectUv("cylindrical", {0, -3, 7}, 0.75, 7);
  expectUv("cylindrical 1 1 1  0 0 5  1 0 0", {1, 2, 3}, 0.25, 2);
  expectUv("cylindrical", {0, 0, 4}, 0, 4);
}

TEST(Cylindrical, TangentsIgnoreTheOriginLikeTheOriginals) {
  const MappedCoordinates at = coordinatesOf(mapping("cylindrical 5 0 0  0 0 1  1 0 0"), {4, 0, 1});
  expectNear(at.dpdu, {0, 1, 0});
  expectNear(at.dpdv, {0, 0, 1});
}

TEST(Planar, IsXAndYByDefault) { expectUv("planar", {3, -4, 9}, 3, -4); }

TEST(Planar, ScalesByTheLengthsOfItsAxesAndIgnoresTheOrigin) {
  // v along z times 2, u along x times 4
  expectUv("planar 7 7 7  0 0 2  4 0 0", {8, 5, 3}, 2, 1.5);
}

TEST(Planar, SolvesForObliqueAxes) {
  // p = u (1, .5, 0) + v (0, 0, 1) + w (upright on both)
  const Vec3 along{1, 0.5, 0}, up{0, 0, 1}, upright = cross(along, up);
  expectUv("planar 0 0 0  0 0 1  1 0.5 0", 3 * along + -2 * up + 5 * upright, 3, -2);
  expectUv("planar 0 0 0  1 1 0  1 0 0", {3, 2, 6}, 1, 2);
}

TEST(Mapping, ThatIsDegenerateOrUnknownIsRefused) {
  for (const char* text : {"spherical 0 0 0 0 0 1 0 0 2", "planar 0 0 0 0 0 0 1 0 0",
                           "cylindrical 0 0 0 0 0 0 1 0 0", "conical", "planar 1 2 3"}) {
    TextArguments in(text);
    EXPECT_THROW(parseMapping(in), std::runtime_error) << text;
  }
}

TEST(Mapping, SurvivesTheWireUnchanged) {
  const Bytes bytes = encode(mapping("cylindrical 1 1 1  0 3 5  1 0 0"));
  const auto back = decode<Mapping>(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(encode(*back), bytes);
  Bytes wrong = bytes;
  wrong[0] = std::byte{4};
  EXPECT_FALSE(decode<Mapping>(wrong));
}

// P: scaled by 2 and moved, T: turned by 90 degrees about z, x -> y.
TexturePlace placed() {
  TexturePlace place;
  place.object = then(*scaling({2, 2, 2}), translation({10, 0, 0}));
  place.texture = rotation({0, 0, 1}, 90);
  place.position = {14, 6, 8};
  place.geometricNormal = {0, 0, 1};
  return place;
}

TEST(PrimitiveLookup, UsesTheOrderOfTheOriginal) {
  // T^-1: (6, -14, 8); P^-1: (-2, -7, 4); T: (7, -2, 4).  P^-1 alone would be (2, 3, 4).
  expectNear(toPrimitive(placed(), placed().position), {7, -2, 4});
  TexturePlace untransformedTexture = placed();
  untransformedTexture.texture = {};
  expectNear(toPrimitive(untransformedTexture, placed().position), {2, 3, 4});
  expectNear(toPrimitiveVector(placed(), {2, 0, 0}), {1, 0, 0});
}

TEST(PrimitiveLookup, IsOnlyAskedForUv) {
  auto never = [](Vec3) -> MappedCoordinates {
    ADD_FAILURE();
    return {};
  };
  mapCoordinates(mapping("planar"), placed(), never);
  Vec3 asked;
  mapCoordinates(mapping("uv"), placed(), [&asked](Vec3 p) {
    asked = p;
    return MappedCoordinates{};
  });
  expectNear(asked, {7, -2, 4});
}

TEST(MappedCoordinates, GoThroughTheInverseTextureTransforms) {
  TexturePlace place;
  place.texture = then(*scaling({0.2, 0.5, 1}), translation({0.1, 0, 0}));
  const MappedCoordinates at = mapCoordinates(Mapping{}, place, [](Vec3) {
    return MappedCoordinates{0.5, 0.25, {1, 0, 0}, {0, 1, 0}};
  });
  EXPECT_NEAR(at.u, 2, kClose);
  EXPECT_NEAR(at.v, 0.5, kClose);
}

TEST(MappedCoordinates, TangentsAreTurnedByObjectAndTexture) {
  const MappedCoordinates at = throughTransforms(placed(), {0, 0, {1, 0, 0}, {0, 1, 0}});
  expectNear(at.dpdu, {0, 1, 0});  // rows of T: x -> y, y -> -x
  expectNear(at.dpdv, {-1, 0, 0});
  EXPECT_TRUE(isFinite(throughTransforms(placed(), {}).dpdu)) << "tangents may be missing";
}

TEST(ApplyTexture, GivesThePositionInTextureSpace) {
  TexturePlace place = placed();
  place.position = {1.25, 0.5, 0};  // in texture space (0.5, -1.25, 0): cells 0, 2, 1
  TextureHit hit;
  Surface odd;
  odd.diffuse = kWhite;
  applyTexture(Checker{odd}, hit, place, [](Vec3) { return MappedCoordinates{}; });
  EXPECT_NEAR(hit.position.x, 0.5, kClose);
  EXPECT_NEAR(hit.position.y, -1.25, kClose);
  EXPECT_EQ(hit.surface.diffuse, kWhite);
}

TEST(ApplyTexture, TakesTheRayOfACloudToThePrimitive) {
  TexturePlace place = placed();
  place.texture = {};
  place.rayOrigin = {10, -8, 0};
  place.rayDirection = {0, 3, 0};
  TextureHit hit;
  applyTexture(Cloud{}, hit, place, [](Vec3) { return MappedCoordinates{}; });
  EXPECT_EQ(hit.rayOrigin, (Vec3{0, -4, 0}));
  EXPECT_EQ(hit.rayDirection, (Vec3{0, 1, 0}));
}

}  // namespace
}  // namespace rayshade
