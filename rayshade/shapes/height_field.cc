// The edges are watertight: a ray passes on one side of an edge or exactly through it, and both triangles
// that share the edge see the same.  For that the corners are moved and sheared so that the ray becomes the
// z axis, and the side is the sign of a 2x2 determinant, taken without error.  A ray exactly through an edge
// or a corner hits all triangles there, at one t that is computed from the edge or corner alone.
// Source: Woop, Benthin & Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/height_field.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace rayshade {
namespace {

bool isHole(float z) { return !(z > -1000 && std::isfinite(z)); }

float heightAt(const Heights& h, std::int32_t x, std::int32_t y) {
  return h
      .values[static_cast<std::size_t>(y) * static_cast<std::size_t>(h.size) + static_cast<std::size_t>(x)];
}
Vec3 cornerAt(const Heights& h, std::int32_t x, std::int32_t y) {
  const double cells = h.size - 1;
  return {x / cells, y / cells, heightAt(h, x, y)};
}

void widen(HeightRange& range, const HeightRange& by) {
  range.low = std::min(range.low, by.low);
  range.high = std::max(range.high, by.high);
}

// A square of the quadtree: level 0 is one cell, level k is 2^k cells along a side.
struct Square {
  int level;
  std::int32_t x, y;
};

// How many squares of a level lie along a side.
std::int32_t squaresAcross(const Heights& h, int level) { return ((h.size - 2) >> level) + 1; }

HeightRange rangeOf(const Heights& h, const Square& square) {
  if (square.level > 0) {
    const auto across = static_cast<std::size_t>(squaresAcross(h, square.level));
    return h.ranges[static_cast<std::size_t>(square.level) - 1]
                   [static_cast<std::size_t>(square.y) * across + static_cast<std::size_t>(square.x)];
  }
  HeightRange range;
  for (const int corner : {0, 1, 2, 3}) {
    const float z = heightAt(h, square.x + corner % 2, square.y + corner / 2);
    if (!isHole(z)) widen(range, {z, z});
  }
  return range;
}

int levelsOf(const Heights& h) { return static_cast<int>(h.ranges.size()); }

// The ray as the z axis: a shear along the axis it follows most, the same for every corner.
struct Shear {
  int x, y, z;
  double alongX, alongY, alongZ;
  Vec3 origin;

  explicit Shear(const LocalRay& ray) : origin(ray.origin) {
    z = dominantAxis(ray.direction);
    x = (z + 1) % 3;
    y = (z + 2) % 3;
    alongX = ray.direction[x] / ray.direction[z];
    alongY = ray.direction[y] / ray.direction[z];
    alongZ = 1 / ray.direction[z];
  }
  // x, y across the ray; z is t.
  Vec3 operator()(Vec3 p) const {
    const Vec3 d = p - origin;
    return {d[x] - alongX * d[z], d[y] - alongY * d[z], d[z] * alongZ};
  }
};

// a.x b.y - a.y b.x with an exact sign: rounding keeps the order of the products, and if they round to the
// same number their rounding errors decide.
double side(Vec3 a, Vec3 b) {
  const double p = a.x * b.y, q = a.y * b.x;
  if (p != q) return p - q;
  return std::fma(a.x, b.y, -p) - std::fma(a.y, b.x, -q);
}

using Triangle = std::array<Vec3, 3>;  // corners, counter-clockwise seen from +z

// The two triangles of a cell, lower left and upper right.
Triangle triangleOf(const Heights& h, std::int32_t x, std::int32_t y, int half) {
  const Vec3 right = cornerAt(h, x + 1, y), up = cornerAt(h, x, y + 1);
  return half == 0 ? Triangle{{cornerAt(h, x, y), right, up}}
                   : Triangle{{cornerAt(h, x + 1, y + 1), up, right}};
}

struct Meeting {
  double t = kNoHit;
  std::array<double, 3> weights{};  // of the corners; their sum is 1
};

// The same, right to the last digits also where the products nearly cancel: a weight.  Source: shear.h.
double weight(Vec3 a, Vec3 b) {
  const double q = a.y * b.x;
  return std::fma(a.x, b.y, -q) + std::fma(-a.y, b.x, q);
}

// How much the origin is a share of `a`, if it lies on the line from a to b; the share of b is shareOf(b, a),
// and exchanging the names changes no bit.
double shareOf(Vec3 a, Vec3 b) {
  const bool alongX = std::abs(b.x - a.x) > std::abs(b.y - a.y);
  return alongX ? b.x / (b.x - a.x) : b.y / (b.y - a.y);
}

Meeting meet(const Shear& shear, const Triangle& triangle) {
  const std::array<Vec3, 3> p{shear(triangle[0]), shear(triangle[1]), shear(triangle[2])};
  std::array<double, 3> w{side(p[1], p[2]), side(p[2], p[0]), side(p[0], p[1])};
  if ((w[0] < 0 || w[1] < 0 || w[2] < 0) && (w[0] > 0 || w[1] > 0 || w[2] > 0)) return {};
  w = {weight(p[1], p[2]), weight(p[2], p[0]), weight(p[0], p[1])};
  const double sum = w[0] + w[1] + w[2];
  if (!(sum != 0 && std::isfinite(sum))) return {};  // the ray lies in the plane
  for (double& weight : w) weight /= sum;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    if (w[a] == 0 && w[b] != 0 && w[c] != 0) {
      w[b] = shareOf(p[b], p[c]);
      w[c] = shareOf(p[c], p[b]);
      return {w[b] * p[b].z + w[c] * p[c].z, w};
    }
  }
  return {w[0] * p[0].z + w[1] * p[1].z + w[2] * p[2].z, w};
}

// Goes through the quadtree near to far and keeps the first meeting beyond tMin.
struct Search {
  const Heights& heights;
  const LocalRay& ray;
  double tMin;
  Shear shear{ray};
  double margin;  // more than the shear's rounding can move a corner
  Meeting best{};
  Triangle triangle{};

  Search(const Heights& h, const LocalRay& r, double t, const Bounds& all)
      : heights(h),
        ray(r),
        tMin(t),
        margin(4 * kRounding * (maxAbs(r.origin) + maxAbs(all.low) + maxAbs(all.high))) {}

  // Can the ray meet the square beyond tMin and before the best meeting?
  bool reaches(const Square& square, const HeightRange& range) const {
    const double cells = heights.size - 1;
    const double x0 = std::ldexp(square.x, square.level), y0 = std::ldexp(square.y, square.level);
    const double width = std::ldexp(1.0, square.level);
    const Vec3 low{x0 / cells, y0 / cells, range.low};
    const Vec3 high{std::min(x0 + width, cells) / cells, std::min(y0 + width, cells) / cells, range.high};
    double near = tMin - margin, far = best.t + margin;
    for (int axis = 0; axis < 3; ++axis) {
      const double o = ray.origin[axis], d = ray.direction[axis];
      const double toLow = low[axis] - margin - o, toHigh = high[axis] + margin - o;
      if (d == 0) {
        if (toLow > 0 || toHigh < 0) return false;
        continue;
      }
      near = std::max(near, (d > 0 ? toLow : toHigh) / d);
      far = std::min(far, (d > 0 ? toHigh : toLow) / d);
    }
    return near <= far;
  }

  void visit(const Square& square) {
    const HeightRange range = rangeOf(heights, square);
    if (!(range.low <= range.high) || !reaches(square, range)) return;
    if (square.level == 0) return visitCell(square.x, square.y);
    const std::int32_t across = squaresAcross(heights, square.level - 1);
    const int nearX = ray.direction.x < 0, nearY = ray.direction.y < 0;
    for (const int child : {0, 1, 2, 3}) {
      const Square part{square.level - 1, 2 * square.x + (child % 2 ^ nearX),
                        2 * square.y + (child / 2 ^ nearY)};
      if (part.x < across && part.y < across) visit(part);
    }
  }

  void visitCell(std::int32_t x, std::int32_t y) {
    for (const int half : {0, 1}) {
      const Triangle candidate = triangleOf(heights, x, y, half);
      bool whole = true;
      for (const Vec3& corner : candidate) whole = whole && !isHole(static_cast<float>(corner.z));
      if (!whole) continue;
      const Meeting m = meet(shear, candidate);
      if (!(m.t > tMin && m.t < best.t)) continue;
      best = m;
      triangle = candidate;
    }
  }
};

Search searched(const HeightField& field, const LocalRay& ray, double tMin) {
  Search search(*field.heights, ray, tMin, field.bounds());
  search.visit({levelsOf(*field.heights), 0, 0});
  return search;
}

}  // namespace

std::shared_ptr<const Heights> makeHeights(std::int32_t size, std::vector<float> values) {
  const auto side = static_cast<std::uint64_t>(std::max(size, 0));
  if (size < 2 || values.size() != side * side) return nullptr;
  auto heights = std::make_shared<Heights>();
  heights->size = size;
  heights->values = std::move(values);
  for (int level = 1; squaresAcross(*heights, level - 1) > 1; ++level) {
    const std::int32_t across = squaresAcross(*heights, level), below = squaresAcross(*heights, level - 1);
    std::vector<HeightRange> ranges;
    ranges.reserve(static_cast<std::size_t>(across) * static_cast<std::size_t>(across));
    for (std::int32_t y = 0; y < across; ++y) {
      for (std::int32_t x = 0; x < across; ++x) {
        HeightRange range;
        for (std::int32_t j = 2 * y; j < std::min(2 * y + 2, below); ++j)
          for (std::int32_t i = 2 * x; i < std::min(2 * x + 2, below); ++i)
            widen(range, rangeOf(*heights, {level - 1, i, j}));
        ranges.push_back(range);
      }
    }
    heights->ranges.push_back(std::move(ranges));
  }
  return heights;
}

std::optional<HeightField> HeightField::parse(Arguments& in) {
  const std::string name = in.fileName();
  std::error_code error;
  // A pipe or a folder has no size that could be checked before memory is taken.
  if (!std::filesystem::is_regular_file(name, error)) in.fail(name + ": cannot be read as a height field");
  const std::uintmax_t bytes = std::filesystem::file_size(name, error);
  std::ifstream file(name, std::ios::binary);
  if (error || !file) in.fail(name + ": cannot be read as a height field");

  std::int32_t size = 0;
  file.read(reinterpret_cast<char*>(&size), sizeof size);
  if (!file) in.fail(name + ": not enough height-field data");
  if (size < 2) in.fail(name + ": a height field needs 2 x 2 heights or more");
  const std::uint64_t count = static_cast<std::uint64_t>(size) * static_cast<std::uint64_t>(size);
  if (count > (bytes - sizeof size) / sizeof(float)) in.fail(name + ": not enough height-field data");
  std::vector<float> values(count);
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(float)));
  if (!file) in.fail(name + ": not enough height-field data");
  return HeightField{makeHeights(size, std::move(values))};
}

Bounds HeightField::bounds() const {
  if (!heights) return {};
  const HeightRange all = rangeOf(*heights, {levelsOf(*heights), 0, 0});
  if (!(all.low <= all.high)) return {};
  return {{0, 0, all.low}, {1, 1, all.high}};
}

double HeightField::intersect(const LocalRay& ray, double tMin) const {
  const bool usable = heights && isFinite(ray.origin) && isFinite(ray.direction);
  return usable ? searched(*this, ray, tMin).best.t : kNoHit;
}

ShapePoint HeightField::pointAt(const LocalRay& ray, double t) const {
  const Search search = searched(*this, ray, std::nextafter(t, -kInfinity));
  const auto& [a, b, c] = search.triangle;
  const auto& [wa, wb, wc] = search.best.weights;
  const Vec3 normal = normalize(cross(b - a, c - a));
  const double error = kRounding * (maxAbs(a) + maxAbs(b) + maxAbs(c));
  return {wa * a + wb * b + wc * c, normal, normal, {}, error, kInfinity};
}

SurfaceCoordinates HeightField::coordinates(const ShapePoint& at, Vec3 position) const {
  const Vec3 n = at.geometricNormal;
  return {position.x, position.y, normalize({n.z, 0, -n.x}), normalize({0, n.z, -n.y})};
}

}  // namespace rayshade
