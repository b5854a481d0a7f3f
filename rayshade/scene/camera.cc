// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/camera.h"

#include <numbers>

namespace rayshade {
namespace {

struct Axes {
  double distance;
  Vec3 sight, right, up;
};

std::optional<Axes> axesOf(Vec3 eye, const Camera& camera) {
  const Vec3 way = camera.target - eye;
  const Vec3 sight = normalize(way);
  const Vec3 across = cross(sight, normalize(camera.up));
  // Parallel up to rounding: rayshade's limit, but of two unit vectors, so that no scale of the scene matters.
  if (!(length(across) >= 1e-5) || !isFinite(sight)) return std::nullopt;
  const Vec3 right = normalize(across);
  return Axes{length(way), sight, right, normalize(cross(right, sight))};
}

}  // namespace

std::optional<View> viewOf(const Camera& camera, const PictureSpec& picture) {
  Vec3 eye = camera.eye;
  auto axes = axesOf(eye, camera);
  if (!axes) return std::nullopt;
  if (camera.eyeShown != Camera::Eye::middle) {
    const double half = camera.eyeSeparation.value_or(0) / 2;
    eye = eye + (camera.eyeShown == Camera::Eye::left ? -half : half) * axes->right;
    axes = axesOf(eye, camera);
    if (!axes) return std::nullopt;
  }
  const double verticalFov =
      camera.verticalFov.value_or(camera.horizontalFov * picture.height / picture.width);
  auto pixel = [&](double degrees, int count) {
    return 2 * axes->distance * std::tan(degrees / 2 * std::numbers::pi / 180) / count;
  };
  View view;
  view.eye = eye;
  view.right = pixel(camera.horizontalFov, picture.width) * axes->right;
  view.down = -pixel(verticalFov, picture.height) * axes->up;
  view.first = camera.target - eye - 0.5 * picture.height * view.down - 0.5 * picture.width * view.right;
  view.lensRight = camera.aperture * axes->right;
  view.lensUp = camera.aperture * axes->up;
  view.focalDistance = camera.focalDistance.value_or(axes->distance);
  return view;
}

Ray primaryRay(const View& view, const SamplePosition& at, std::int32_t frame) {
  Ray ray;
  ray.origin = view.eye;
  ray.direction = normalize(view.first + at.u * view.right + at.v * view.down);
  ray.moment = {at.time, frame};
  ray.sample = at.number;
  ray.key = at.key;
  if (view.lensRight == Vec3{} && view.lensUp == Vec3{}) return ray;
  const LensPosition through = lensPosition(at);
  const Vec3 lens = through.x * view.lensRight + through.y * view.lensUp;
  if (lens != Vec3{}) {
    ray.origin = ray.origin + lens;
    ray.direction = normalize(view.focalDistance * ray.direction - lens);
  }
  return ray;
}

}  // namespace rayshade
