// Placed surfaces do not shadow themselves, and what is in front of them does; a lamp in one of them gives light.
//
// Shapes of all kinds, alone, in CSG and in instances, under random chains of transforms: pivots up to 1e6 away, stretches by 1e-6
// to 1e6 and back, shears, mirrors, moving ones.  With a light at the eye no ray can be in a shadow, so with shadows every picture
// is that without.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/placing.h"

#include <gtest/gtest.h>

#include <functional>

#include "rayshade/intersect/bundle_hit.h"
#include "rayshade/shading/evaluate.h"
#include "rayshade/shading/shadow.h"
#include "tests/support/number_text.h"
#include "tests/support/seeded_random.h"
#include "tests/support/text_model.h"

namespace rayshade {
namespace {

// Some transforms that leave an object about where it was, and about as large.
std::string randomChain(Random& random) {
  std::string chain;
  for (int i = random.below(4); i > 0; --i) {
    const bool moves = random.oneIn(4);
    const std::string angle =
        moves ? " (time *" + text(random.real(0, 360)) + ")" : text(random.real(0, 360));
    const Vec3 axis = random.direction();
    switch (random.below(5)) {
      case 0:
        chain += " translate" + text(random.point(-2, 2));
        break;
      case 1: {  // a hinge far away
        const Vec3 pivot = random.magnitude(1, 1e6) * random.direction();
        const double turn = random.real(0, 360);
        const Vec3 back = pivot - mapPoint(rotation(axis, turn).forward, pivot);
        chain += " translate" + text(-pivot) + " rotate" + text(axis) + text(turn) + " translate" +
                 text(pivot) + " translate" + text(-back);
        break;
      }
      case 2: {  // stretched, turned a little, shrunk
        const double by = random.magnitude(1, 1e6);
        Vec3 stretch{1, 1, 1};
        stretch[random.below(3)] = by;
        const Vec3 shrink{1 / stretch.x, 1 / stretch.y, 1 / stretch.z};
        chain += " scale" + text(stretch) + " rotate" + text(axis) + text(random.real(0, 1) / by) + " scale" +
                 text(shrink);
        break;
      }
      case 3:  // sheared, perhaps mirrored
        chain += " transform 1" + text(random.real(-2, 2)) + " 0 0" + text(random.pick({1.0, -1.0})) +
                 text(random.real(-2, 2)) + " 0 0 1";
        break;
      default:
        chain += " rotate" + text(axis) + angle;
    }
  }
  return chain;
}

std::string randomShape(Random& random) {
  switch (random.below(10)) {
    case 0:
      return "sphere 1 0 0 0";
    case 1:
      return "box -1 -1 -1 1 1 1";
    case 2:
      return "cylinder 0.8 0 0 -1 0 0 1";
    case 3:
      return "cone 1 0 0 -1 0.2 0 0 1";
    case 4:
      return "torus 0.8 0.3 0 0 0 0 0 1";
    case 5:
      return "triangle -1 -1 0 1 -1 0.3 0 1 0";
    case 6: {  // out of its plane
      const double warp = random.magnitude(1e-14, 0.3);
      return "poly -1 -1 0 1 -1" + text(warp) + " 1 1 0 -1 1 0";
    }
    case 7:
      return "disc 1 0 0 0 0.3 0 1";
    case 8:
      return "blob 0.5 1 1 0 0 0 1 0.8 0.7 0 0";
    default:
      return "plane 0 0 0 0.1 0.2 1";
  }
}

// `part`: there is a name for something to be placed.
std::string randomObject(Random& random, int depth, bool part) {
  if (depth == 0 || random.oneIn(2)) return randomShape(random) + randomChain(random) + "\n";
  switch (part ? random.below(3) : random.below(2)) {
    case 0:
      return "list " + randomObject(random, depth - 1, part) + "end" + randomChain(random) + "\n";
    case 2:
      return "object part" + randomChain(random) + "\n";
    default:
      return random.pick({std::string("union "), std::string("difference ")}) + "sphere 1.2 0 0 0.2" +
             randomChain(random) + "\n" + "box -1 -1 0.3 1 1 1.5" + randomChain(random) + " end" +
             randomChain(random) + "\n";
  }
}

struct Placed : TextModel {
  explicit Placed(const std::string& scene) : TextModel(scene, {0, 1, 0}) {}

  bool dark(const Ray& ray, const SurfacePoint& at, Vec3 light) const {
    const Vec3 way = light - at.position;
    const LightSample sample{normalize(way), normalize(way), length(way), 1};
    const ShadowLine line = shadowLine(at, sample);
    Segment segment(line.origin, line.direction, line.distance, ray.moment);
    Occlusion met;
    occlusions(model, region, std::span(&segment, 1), std::span(&met, 1));
    return met.opaque || met.transparent;
  }

  SceneSettings settings;
};

// What some rays from an eye see of a random scene.
struct Seen {
  const std::string& scene;
  const Placed& placed;
  Ray ray;
  SurfacePoint at;
};
void forRandomScenes(const std::function<void(const Seen&, Random&)>& use) {
  const std::uint64_t count = seedCount(3000);
  std::uint64_t hits = 0, left = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SeededRandom random(seed);
    const std::string scene =
        "name part list " + randomObject(random, 1, false) + "end\n" + randomObject(random, 2, true);
    std::unique_ptr<Placed> placed;
    try {
      placed = std::make_unique<Placed>(scene);
    } catch (const SceneError&) {
      ++left;  // the chain has no inverse
      continue;
    }
    const Vec3 eye = 8.0 * random.direction();
    for (int i = 0; i < 30; ++i) {
      Ray ray;
      ray.origin = eye;
      ray.direction = normalize(random.point(-1.5, 1.5) - eye);
      ray.moment = {random.real(0, 1), 0};
      const Hit hit = nearestHit(placed->model, placed->region, ray, 0, kInfinity);
      if (!hit.found()) continue;
      ++hits;
      SurfacePoint at;
      evaluateSurface(placed->model, hit, ray, placed->settings, at);
      use({scene, *placed, ray, at}, random);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
  EXPECT_GT(hits, count * 3);
  EXPECT_LT(left, count / 100 + 2);
}

TEST(Placing, NoSurfaceShadowsItself) {
  forRandomScenes([](const Seen& seen, Random&) {
    ASSERT_FALSE(seen.placed.dark(seen.ray, seen.at, seen.ray.origin)) << "error " << seen.at.error << "\n"
                                                                       << seen.scene;
  });
}

TEST(Placing, ASheetAHundredBoundsInFrontShadows) {
  forRandomScenes([](const Seen& seen, Random& random) {
    if (!random.oneIn(20)) return;
    const Vec3 n = seen.at.geometricNormal;
    const Placed sheet("plane" + text(seen.at.position + 100 * seen.at.error * n) + text(n));
    if (-dot(n, seen.ray.direction) < 0.01) return;
    ASSERT_TRUE(sheet.dark(seen.ray, seen.at, seen.ray.origin)) << "error " << seen.at.error << "\n"
                                                                << seen.scene;
  });
}

// The eye looks at a lamp where it saw the surface, or a little behind that.
TEST(Placing, ALampInASurfaceGivesLightAndBehindItNone) {
  int judged = 0;
  forRandomScenes([&](const Seen& seen, Random&) {
    SurfacePoint eye;
    eye.position = seen.ray.origin;
    ASSERT_FALSE(seen.placed.dark(seen.ray, eye, seen.at.position)) << "error " << seen.at.error << "\n"
                                                                    << seen.scene;
    if (seen.at.error > 1e-7 || -dot(seen.at.geometricNormal, seen.ray.direction) < 0.05) return;
    ++judged;
    ASSERT_TRUE(seen.placed.dark(seen.ray, eye, seen.at.position - 1e-6 * seen.at.geometricNormal))
        << "error " << seen.at.error << "\n"
        << seen.scene;
  });
  EXPECT_GT(judged, static_cast<int>(seedCount(3000)));
}

}  // namespace
}  // namespace rayshade
