// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/oracle/oracle.h"

#include <stdexcept>

#include "rayshade/shapes/all.h"
#include "tests/support/oracle/verdict.h"

namespace rayshade {
namespace {

constexpr std::string_view kNames[] = {
    "sphere",  "box",   "plane", "disc",        "cylinder", "cone", "triangle", "phongtriangle", "triangleuv",
    "polygon", "torus", "blob",  "heightfield", "fan",      "slab", "voxel",    "pyramid"};
constexpr Examine* kExamine[] = {examineShape<Sphere>,
                                 examineShape<Box>,
                                 examineShape<Plane>,
                                 examineShape<Disc>,
                                 examineShape<Cylinder>,
                                 examineShape<Cone>,
                                 examineShape<Triangle>,
                                 examineShape<PhongTriangle>,
                                 examineShape<TriangleUv>,
                                 examineShape<Polygon>,
                                 examineShape<Torus>,
                                 examineShape<Blob>,
                                 examineShape<HeightField>,
                                 examineFan,
                                 examineSlab,
                                 examineVoxel,
                                 examinePyramid};
static_assert(std::size(kNames) == std::size(kExamine));

}  // namespace

std::span<const std::string_view> oracleClasses() { return kNames; }

OracleReport examine(std::string_view name, std::uint64_t seed, std::uint64_t first, std::uint64_t count) {
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (kNames[i] != name) continue;
    OracleReport report;
    for (std::uint64_t number = first; number < first + count; ++number)
      kExamine[i](report, name, seed, number);
    report.cases = count;
    return report;
  }
  throw std::invalid_argument("no class of that name: " + std::string(name));
}

}  // namespace rayshade
