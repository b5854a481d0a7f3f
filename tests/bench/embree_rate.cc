// Rays per second on one core beside Embree: tracing alone, no shading.  `make bench-embree` (Debian: libembree-dev).
//
//   bin/bench/embree_rate SCENE.ray [SIDE]
//
// The flat triangles of a scene (those in no frame) and the rays of its camera, SIDE x SIDE of them (1024), and from each hit a
// shadow ray to the first point light.  Ours go in bundles of 32, as in the sequential program, and one by one; Embree's one by
// one (rtcIntersect1, rtcOccluded1).  The error stands beside the speed: ours is in double precision and without leaks; how many
// of Embree's rays, which are single precision, hit another triangle or none is counted.
// SPDX-License-Identifier: BSD-3-Clause
#include <embree3/rtcore.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "rayshade/intersect/bundle_hit.h"
#include "rayshade/intersect/ray_hit.h"
#include "rayshade/language/parser.h"
#include "rayshade/trace/render.h"

namespace rayshade {
namespace {

double secondsOf(auto&& work) {
  double least = kInfinity;
  for (int run = 0; run < 3; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return least;
}

struct Rates {
  double bundles, alone, embree;  // million rays a second
};
void print(const char* what, std::size_t rays, Rates seconds, std::size_t others) {
  const double million = 1e-6 * static_cast<double>(rays);
  std::printf("%s\t%zu\t%.2f\t%.2f\t%.2f\t%.2f\t%.1f\n", what, rays, million / seconds.bundles,
              million / seconds.alone, million / seconds.embree, seconds.embree / seconds.bundles,
              1e6 * static_cast<double>(others) / static_cast<double>(rays));
}

struct EmbreeScene {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);

  explicit EmbreeScene(std::span<const Triangle> triangles) {
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corner = static_cast<float*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * triangles.size()));
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.size()));
    unsigned next = 0;
    for (const Triangle& triangle : triangles)
      for (const Vec3& p : triangle.corners) {
        *corner++ = static_cast<float>(p.x);
        *corner++ = static_cast<float>(p.y);
        *corner++ = static_cast<float>(p.z);
        *index++ = next++;
      }
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

RTCRay embreeRay(Vec3 origin, Vec3 direction, double tFar) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x);
  ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tfar = static_cast<float>(tFar);
  ray.mask = ~0u;
  return ray;
}

int measure(const std::string& file, std::int32_t side) {
  ParseOptions options;
  options.fileName = file;
  Model whole;
  SceneHead head = parseScene(options, whole.store());
  whole.prepare({});
  // The triangles alone, in both programs.
  Model model;
  std::vector<Triangle> triangles;
  for (ObjectIndex object : whole.store().objectsOf(kWorld)) {
    const PlacedObject& placed = whole.store().object(object);
    if (placed.kind != kKindOf<Triangle> || !whole.store().frame(placed.frame).identity) continue;
    triangles.push_back(whole.store().shapes<Triangle>()[placed.body]);
    model.store().object({ObjectId{static_cast<std::uint32_t>(triangles.size())}, kWorld, kRootNode,
                          kNoSurface, AnyShape(triangles.back())});
  }
  if (triangles.empty()) {
    std::fprintf(stderr, "%s: no flat triangles\n", file.c_str());
    return 1;
  }
  model.prepare({});
  const auto objects = model.store().objectsOf(kWorld);
  const Region region = model.regionOf({objects.begin(), objects.end()});
  const EmbreeScene embree(triangles);

  head.picture.width = head.picture.height = side;
  head.picture.jitter = false;
  head.picture.samplesPerSide = 1;
  const View view = *viewOf(head.camera, head.picture);
  std::vector<Ray> rays;
  for (std::int32_t y = 0; y < side; y += 4)  // blocks of 8 x 4, a bundle each
    for (std::int32_t x = 0; x < side; x += 8)
      for (std::int32_t i = 0; i < 32; ++i)
        rays.push_back(primaryRay(view, samplePosition(head.picture, 0, 0, {x + i % 8, y + i / 8, 0}), 0));

  std::vector<Hit> hits(rays.size());
  std::vector<unsigned> theirs(rays.size());
  Rates seconds{};
  const auto forBundles = [](std::size_t count, auto&& use) {
    for (std::size_t first = 0; first < count; first += kBundleSize)
      use(first, std::min(kBundleSize, count - first));
  };
  seconds.bundles = secondsOf([&] {
    forBundles(rays.size(), [&](std::size_t first, std::size_t count) {
      Segment segments[kBundleSize];
      for (std::size_t i = 0; i < count; ++i) segments[i] = Segment(rays[first + i]);
      nearestHits(model, region, std::span(segments).first(count), std::span(hits).subspan(first, count));
    });
  });
  seconds.alone = secondsOf([&] {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = nearestHit(model, region, rays[i], 0, kInfinity);
  });
  seconds.embree = secondsOf([&] {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RTCRayHit hit{embreeRay(rays[i].origin, rays[i].direction, kInfinity), {}};
      hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(embree.scene, &context, &hit);
      theirs[i] = hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? ~0u : hit.hit.primID;
    }
  });
  std::size_t others = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const unsigned ours =
        hits[i].found() ? static_cast<unsigned>(number(model.store().object(hits[i].object).id)) - 1 : ~0u;
    others += ours != theirs[i];
  }
  std::printf(
      "rays\tnumber\tbundles M/s\talone M/s\tEmbree M/s\tbundles/Embree\tother answers per million\n");
  print("primary", rays.size(), seconds, others);

  const auto light =
      std::find_if(head.settings.lights.begin(), head.settings.lights.end(),
                   [](const LightSource& l) { return std::holds_alternative<PointLight>(l.kind); });
  if (light == head.settings.lights.end()) return 0;
  const Vec3 lamp = std::get<PointLight>(light->kind).position;
  std::vector<Ray> shadows;
  std::vector<double> distances;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].found()) continue;
    Ray shadow = rays[i];
    const Vec3 at = rays[i].origin + (hits[i].t * (1 - 1e-6)) * rays[i].direction;
    shadow.origin = at;
    shadow.direction = normalize(lamp - at);
    shadows.push_back(shadow);
    distances.push_back(length(lamp - at));
  }
  std::vector<char> dark(shadows.size()), darkThere(shadows.size());
  seconds.bundles = secondsOf([&] {
    forBundles(shadows.size(), [&](std::size_t first, std::size_t count) {
      Segment segments[kBundleSize];
      Occlusion met[kBundleSize];
      for (std::size_t i = 0; i < count; ++i)
        segments[i] = Segment(shadows[first + i], 0, distances[first + i]);
      occlusions(model, region, std::span(segments).first(count), met);
      for (std::size_t i = 0; i < count; ++i) dark[first + i] = met[i].opaque;
    });
  });
  seconds.alone = secondsOf([&] {
    for (std::size_t i = 0; i < shadows.size(); ++i) {
      Segment segment(shadows[i], 0, distances[i]);
      Occlusion met;
      occlusions(model, region, std::span(&segment, 1), std::span(&met, 1));
      dark[i] = met.opaque;
    }
  });
  seconds.embree = secondsOf([&] {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = 0; i < shadows.size(); ++i) {
      RTCRay ray = embreeRay(shadows[i].origin, shadows[i].direction, distances[i]);
      rtcOccluded1(embree.scene, &context, &ray);
      darkThere[i] = ray.tfar < 0;
    }
  });
  others = 0;
  for (std::size_t i = 0; i < shadows.size(); ++i) others += dark[i] != darkThere[i];
  print("shadow", shadows.size(), seconds, others);
  return 0;
}

}  // namespace
}  // namespace rayshade

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: embree_rate SCENE.ray [SIDE]\n");
    return 2;
  }
  try {
    const int side = argc > 2 ? std::atoi(argv[2]) : 1024;
    return rayshade::measure(argv[1], std::clamp(side / 8 * 8, 8, 8192));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
