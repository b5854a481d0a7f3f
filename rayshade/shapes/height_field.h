// The height field: a square landscape of flat triangles.
//
//   heightfield FILE       x, y in [0, 1], z from the file                                     [object units]
//
// The file holds an int32 n and n * n float32 in the byte order of the machine, row by row: value k is the
// height at x = (k mod n)/(n-1), y = (k div n)/(n-1).  A height of -1000 or less, or one that is no number,
// is a hole: the triangles that touch it vanish.  Each cell is cut by the diagonal from (x+1, y) to (x, y+1).
// Rays find the cells through a quadtree of least and greatest heights, built where the heights arrive and
// never sent.  Copies share the heights.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rayshade/shapes/shape.h"

namespace rayshade {

struct HeightRange {
  float low = HUGE_VALF, high = -HUGE_VALF;  // empty
};

struct Heights {
  std::int32_t size = 0;      // values along a side
  std::vector<float> values;  // size * size
  // ranges[k] has squares of 2^(k+1) cells along a side, row by row; the last one is a single square.
  std::vector<std::vector<HeightRange>> ranges;
};

// Heights with their quadtree; nothing unless size >= 2 and there are size * size values.
std::shared_ptr<const Heights> makeHeights(std::int32_t size, std::vector<float> values);

struct HeightField {
  std::shared_ptr<const Heights> heights;  // none: an empty field

  static constexpr std::string_view keyword = "heightfield";
  static constexpr Aliases<> aliases{};
  static constexpr bool flat = false, unbounded = false, solid = false, beginsWithFile = true;
  static constexpr std::string_view examples[] = {"tests/support/hills.hf"};

  static std::optional<HeightField> parse(Arguments& in);
  Bounds bounds() const;
  double intersect(const LocalRay& ray, double tMin) const;
  ShapePoint pointAt(const LocalRay& ray, double t) const;
  SurfaceCoordinates coordinates(const ShapePoint& at, Vec3 position) const;
};

template <class Archive>
void serialize(Archive& archive, HeightField& h) {
  if constexpr (Archive::kReading) {
    std::int32_t size = 0;
    std::vector<float> values;
    archive(size, values);
    h.heights = makeHeights(size, std::move(values));
    if (!h.heights) archive.fail();
  } else {
    static const Heights kNone;
    const Heights& heights = h.heights ? *h.heights : kNone;
    archive(heights.size, heights.values);
  }
}

}  // namespace rayshade
