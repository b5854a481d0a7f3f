// From positions on the screen to rays, against angles and points worked out by hand.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/camera.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/near.h"

namespace rayshade {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

PictureSpec screen(int width, int height) {
  PictureSpec picture;
  picture.width = width;
  picture.height = height;
  return picture;
}
SamplePosition at(double u, double v) {
  SamplePosition position;
  position.u = u;
  position.v = v;
  return position;
}
Vec3 through(const View& view, double u, double v) { return primaryRay(view, at(u, v), 0).direction; }

// Without a word about it the eye is at (0, -10, 0), looks along y, and z is up.
TEST(Camera, TheMiddleOfTheScreenIsTheTarget) {
  const View view = viewOf(Camera{}, screen(512, 512)).value();
  EXPECT_EQ(view.eye, (Vec3{0, -10, 0}));
  expectNear(through(view, 256, 256), {0, 1, 0});
}

TEST(Camera, TheEdgesOfTheScreenAreHalfTheFieldOfViewAway) {
  const View view = viewOf(Camera{}, screen(512, 512)).value();
  const double tangent = std::tan(22.5 * kDegree);
  expectNear(through(view, 0, 256), normalize({-tangent, 1, 0}));
  expectNear(through(view, 512, 256), normalize({tangent, 1, 0}));
  expectNear(through(view, 256, 0), normalize({0, 1, tangent}));  // the first row is the upper one
  expectNear(through(view, 256, 512), normalize({0, 1, -tangent}));
}

// Linear in the angle: half as many rows get half of the angle, and not of its tangent.
TEST(Camera, TheVerticalFieldOfViewFollowsFromTheShapeOfTheScreen) {
  Camera camera;
  camera.horizontalFov = 90;
  const View wide = viewOf(camera, screen(400, 200)).value();
  expectNear(through(wide, 200, 0), normalize({0, 1, std::tan(22.5 * kDegree)}));
  camera.verticalFov = 60;
  const View said = viewOf(camera, screen(400, 200)).value();
  expectNear(through(said, 200, 0), normalize({0, 1, std::tan(30 * kDegree)}));
}

TEST(Camera, UpNeedsToBeNeitherUnitNorAtARightAngle) {
  Camera camera;
  const View straight = viewOf(camera, screen(100, 80)).value();
  camera.up = {0, 3, 7};
  const View tilted = viewOf(camera, screen(100, 80)).value();
  expectNear(tilted.right, straight.right, 1e-14);
  expectNear(tilted.down, straight.down, 1e-14);
  expectNear(tilted.first, straight.first, 1e-14);
}

TEST(Camera, WithoutADirectionThereIsNoView) {
  Camera camera;
  camera.up = {0, 1, 0};
  EXPECT_FALSE(viewOf(camera, screen(10, 10))) << "up along the line of sight";
  camera.up = {0, -2, 0};
  EXPECT_FALSE(viewOf(camera, screen(10, 10)));
  camera.up = {0, 0, 0};
  EXPECT_FALSE(viewOf(camera, screen(10, 10))) << "no up at all";
  camera = {};
  camera.target = camera.eye;
  EXPECT_FALSE(viewOf(camera, screen(10, 10))) << "eye on the target";
  camera.target = {kInfinity, 0, 0};
  EXPECT_FALSE(viewOf(camera, screen(10, 10)));
}

TEST(Camera, AWholeSceneScaledByAPowerOfTwoHasTheSameRays) {
  Camera camera;
  camera.eye = {1, -7, 3};
  camera.target = {0.3, 0.1, -0.2};
  camera.up = {0.1, 0.2, 1};
  camera.aperture = 0.125;
  const View view = viewOf(camera, screen(33, 21)).value();
  for (const double scale : {0x1p-40, 0x1p+40}) {
    Camera other = camera;
    other.eye = camera.eye * scale;
    other.target = camera.target * scale;
    other.aperture = camera.aperture * scale;
    const View scaled = viewOf(other, screen(33, 21)).value();
    SamplePosition position = at(5.25, 17.5);
    position.key = RandomKey{17};
    const Ray ray = primaryRay(view, position, 0), ray2 = primaryRay(scaled, position, 0);
    EXPECT_EQ(ray2.direction, ray.direction);
    EXPECT_EQ(ray2.origin, ray.origin * scale);
  }
}

TEST(Camera, EyesOfAPairAreApartAndLookAtTheSamePoint) {
  Camera camera;
  camera.eyeSeparation = 0.5;
  camera.eyeShown = Camera::Eye::left;
  const View left = viewOf(camera, screen(64, 64)).value();
  camera.eyeShown = Camera::Eye::right;
  const View right = viewOf(camera, screen(64, 64)).value();
  expectNear(left.eye, {-0.25, -10, 0});
  expectNear(right.eye, {0.25, -10, 0});
  expectNear(through(left, 32, 32), normalize({0.25, 10, 0}));
  expectNear(through(right, 32, 32), normalize({-0.25, 10, 0}));
}

TEST(Camera, RaysThroughAnyPointOfTheLensMeetInFocus) {
  Camera camera;
  camera.aperture = 0.3;
  camera.focalDistance = 6;
  const View view = viewOf(camera, screen(40, 30)).value();
  camera.aperture = 0;
  const Ray middle = primaryRay(viewOf(camera, screen(40, 30)).value(), at(11, 23), 0);
  EXPECT_EQ(middle.origin, camera.eye);
  const Vec3 sharp = middle.origin + 6 * middle.direction;
  for (std::uint64_t key = 0; key < 20; ++key) {
    SamplePosition position = at(11, 23);
    position.key = RandomKey{mixBits(key)};
    const LensPosition lens = lensPosition(position);
    const Ray ray = primaryRay(view, position, 0);
    expectNear(ray.origin, {0.3 * lens.x, -10, 0.3 * lens.y}, 1e-14);
    EXPECT_NEAR(length(ray.direction), 1, 1e-15);
    EXPECT_LT(length(cross(sharp - ray.origin, ray.direction)), 1e-14);
  }
}

TEST(Camera, TheFocusIsOnTheTargetUnlessSaidOtherwise) {
  Camera camera;
  camera.target = {3, -6, 0};
  EXPECT_EQ(viewOf(camera, screen(40, 30)).value().focalDistance, 5);
  camera.focalDistance = 2;
  EXPECT_EQ(viewOf(camera, screen(40, 30)).value().focalDistance, 2);
}

TEST(Camera, RaysMadeTogetherAreThoseMadeOneByOne) {
  PictureSpec picture = screen(40, 30);
  picture.shutter = 0.5;
  std::vector<Ray> rays(3);  // used before
  rays[1].depth = 4;
  rays[1].media.push_back({1.5, 0.9});
  for (const double aperture : {0.0, 0.2}) {
    for (const int side : {1, 3}) {
      picture.samplesPerSide = side;
      Camera camera;
      camera.aperture = aperture;
      const View view = viewOf(camera, picture).value();
      std::vector<SampleId> samples;
      for (std::int32_t n = 0; n < 70; ++n) samples.push_back({n % 40, n / 3, n % (side * side)});
      primaryRays(view, picture, 99, 2, samples, rays);
      ASSERT_EQ(rays.size(), samples.size());
      for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_EQ(encode(rays[i]), encode(primaryRay(view, samplePosition(picture, 99, 2, samples[i]), 2)));
    }
  }
}

TEST(Camera, ARayKnowsItsSample) {
  SamplePosition position = at(1, 2);
  position.time = 0.75;
  position.number = 5;
  position.key = sampleKey(1, 2, 3, 4, 5);
  const Ray ray = primaryRay(viewOf(Camera{}, screen(8, 8)).value(), position, 42);
  EXPECT_EQ(ray.moment.time, 0.75);
  EXPECT_EQ(ray.moment.frame, 42);
  EXPECT_EQ(ray.sample, 5);
  EXPECT_EQ(ray.key, position.key);
  EXPECT_EQ(ray.depth, 0);
  EXPECT_EQ(ray.contribution, kWhite);
  EXPECT_TRUE(ray.media.empty());
}

TEST(Camera, AViewSurvivesTheWire) {
  Camera camera;
  camera.aperture = 0.1;
  const View view = viewOf(camera, screen(7, 5)).value();
  const Bytes bytes = encode(view);
  const auto back = decode<View>(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(encode(*back), bytes);
  EXPECT_FALSE(decode<View>(std::span(bytes).first(bytes.size() - 1)));
}

}  // namespace
}  // namespace rayshade
