#include "scenes/spd/spd.h"

#include <cmath>

namespace rayshade::spd {

namespace {

// The largest sizes are where floating point or patience ends.
constexpr SceneKind kScenes[] = {
    {"balls", 4, 12, writeBalls},      {"gears", 4, 100, writeGears},  {"lattice", 12, 1000, writeLattice},
    {"mount", 6, 14, writeMount},      {"rings", 7, 1000, writeRings}, {"shells", 9, 100, writeShells},
    {"teapot", 12, 2000, writeTeapot}, {"tetra", 6, 14, writeTetra},   {"tree", 11, 30, writeTree},
};

}  // namespace

std::span<const SceneKind> sceneKinds() { return kScenes; }

const SceneKind* findScene(std::string_view name) {
  for (const SceneKind& kind : kScenes) {
    if (kind.name == name) return &kind;
  }
  return nullptr;
}

bool writeScene(const SceneRequest& request, SceneWriter& out) {
  const SceneKind* kind = findScene(request.name);
  if (!kind) return false;
  const int size = request.size == 0 ? kind->usualSize : request.size;
  if (size < 1 || size > kind->largestSize) return false;
  kind->write(size, out);
  out.finish();
  return true;
}

double lightIntensity(int count) { return std::sqrt(count) / count; }

std::uint64_t power(std::uint64_t base, int exponent) {
  std::uint64_t result = 1;
  for (int i = 0; i < exponent; ++i) result *= base;
  return result;
}

}  // namespace rayshade::spd
