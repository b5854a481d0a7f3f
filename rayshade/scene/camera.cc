// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/camera.h"

#include <numbers>

#include "rayshade/base/elementary.h"

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
    return 2 * axes->distance * elementary::tan(degrees / 2 * std::numbers::pi / 180) / count;
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

namespace {

// Moves a ray from the middle of the lens to where its sample goes through, so that it meets its old self in focus.
void throughLens(const View& view, const SamplePosition& at, Ray& ray) {
  const LensPosition through = lensPosition(at);
  const Vec3 lens = through.x * view.lensRight + through.y * view.lensUp;
  if (lens == Vec3{}) return;
  ray.origin = ray.origin + lens;
  ray.direction = normalize(view.focalDistance * ray.direction - lens);
}

bool isPinhole(const View& view) { return view.lensRight == Vec3{} && view.lensUp == Vec3{}; }

// From the middle of the lens through the screen.
Vec3 directionOf(const View& view, const SamplePosition& at) {
  return normalize(view.first + at.u * view.right + at.v * view.down);
}

// Makes a new ray that of a sample.
void aim(Ray& ray, const View& view, const SamplePosition& at, Vec3 direction, std::int32_t frame,
         bool pinhole) {
  ray.origin = view.eye;
  ray.direction = direction;
  ray.moment = {at.time, frame};
  ray.sample = at.number;
  ray.key = at.key;
  if (!pinhole) throughLens(view, at, ray);
}

}  // namespace

Ray primaryRay(const View& view, const SamplePosition& at, std::int32_t frame) {
  Ray ray;
  aim(ray, view, at, directionOf(view, at), frame, isPinhole(view));
  return ray;
}

void primaryRays(const View& view, const PictureSpec& picture, std::uint64_t seed, std::int32_t frame,
                 std::span<const SampleId> samples, std::vector<Ray>& rays) {
  constexpr std::size_t kAtOnce = 32;
  const bool pinhole = isPinhole(view);
  SamplePosition positions[kAtOnce];
  Vec3 directions[kAtOnce];
  rays.clear();
  rays.resize(samples.size());
  for (std::size_t first = 0; first < samples.size(); first += kAtOnce) {
    const std::span some = samples.subspan(first, std::min(kAtOnce, samples.size() - first));
    samplePositions(picture, seed, static_cast<std::uint32_t>(frame), some, positions);
    // In a loop of its own: the roots and divisions of several rays are on their way at a time.
    for (std::size_t i = 0; i < some.size(); ++i) directions[i] = directionOf(view, positions[i]);
    for (std::size_t i = 0; i < some.size(); ++i)
      aim(rays[first + i], view, positions[i], directions[i], frame, pinhole);
  }
}

}  // namespace rayshade
