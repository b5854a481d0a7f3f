// Random rays at tori, blobs and height fields, checked in 113-bit arithmetic.
//
// Torus: the roots of its quartic counted and bisected with Sturm's theorem, no code shared with roots.cc.
// Blob: the density itself, looked at many times along the ray, has to change sides where a crossing was
// found and nowhere else.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "rayshade/shapes/blob.h"
#include "rayshade/shapes/height_field.h"
#include "rayshade/shapes/torus.h"
#include "tests/support/seeded_random.h"
#include "tests/support/shape_subjects.h"

namespace rayshade {
namespace {

using Wide = __float128;

Wide magnitude(Wide x) { return x < 0 ? -x : x; }

using WidePolynomial = std::vector<Wide>;  // c[0] + c[1] x + ...

Wide valueOf(const WidePolynomial& p, Wide x) {
  Wide v = 0;
  for (std::size_t i = p.size(); i-- > 0;) v = v * x + p[i];
  return v;
}

// Sturm's chain: the number of its sign changes falls by one at each root.
struct SturmChain {
  std::vector<WidePolynomial> chain;

  explicit SturmChain(const WidePolynomial& p) {
    WidePolynomial derivative;
    for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(static_cast<Wide>(i) * p[i]);
    chain = {p, derivative};
    while (chain.back().size() > 1) {
      WidePolynomial rest = chain[chain.size() - 2];
      const WidePolynomial& by = chain.back();
      while (rest.size() >= by.size()) {
        const Wide factor = rest.back() / by.back();
        for (std::size_t i = 0; i < by.size(); ++i) rest[rest.size() - by.size() + i] -= factor * by[i];
        rest.pop_back();
      }
      for (Wide& c : rest) c = -c;
      chain.push_back(rest);
    }
  }
  int changes(Wide x) const {
    int count = 0, last = 0;
    for (const WidePolynomial& p : chain) {
      const Wide v = valueOf(p, x);
      const int sign = v > 0 ? 1 : v < 0 ? -1 : 0;
      if (sign != 0 && last != 0 && sign != last) ++count;
      if (sign != 0) last = sign;
    }
    return count;
  }
  void collect(Wide low, Wide high, Wide width, std::vector<double>& roots) const {
    const int count = changes(low) - changes(high);
    if (count == 0) return;
    if (high - low < width) {
      roots.insert(roots.end(), static_cast<std::size_t>(count), static_cast<double>(low));
      return;
    }
    const Wide middle = (low + high) / 2;
    collect(low, middle, width, roots);
    collect(middle, high, width, roots);
  }
};

// The exact quartic of a torus around the z axis at the origin, in t less `shift`.
WidePolynomial exactQuartic(const Torus& torus, const LocalRay& ray, double shift) {
  const Wide dx = ray.direction.x, dy = ray.direction.y, dz = ray.direction.z;
  const Wide x = ray.origin.x + shift * dx, y = ray.origin.y + shift * dy, z = ray.origin.z + shift * dz;
  const Wide swept = torus.swept, tube = torus.tube;
  const Wide a = dx * dx + dy * dy + dz * dz, b = 2 * (x * dx + y * dy + z * dz);
  const Wide c = x * x + y * y + z * z + swept * swept - tube * tube, four = 4 * swept * swept;
  return {c * c - four * (x * x + y * y), 2 * b * c - 2 * four * (x * dx + y * dy),
          b * b + 2 * a * c - four * (dx * dx + dy * dy), 2 * a * b, a * a};
}

// Of a hundred rays the share that grazes so closely that the double origin decides; both answers are right.
bool grazes(const std::vector<double>& exact, const std::vector<double>& found, double size,
            double distance) {
  const double blur = std::sqrt(1e-15 * (size + distance) * size);
  for (const auto& roots : {exact, found})
    for (std::size_t i = 1; i < roots.size(); ++i)
      if (roots[i] - roots[i - 1] < 4 * blur) return true;
  return false;
}

TEST(Torus, AgreesWithSturmFromAnyDistance) {
  SeededRandom random(1);
  int grazing = 0, crossed = 0;
  for (const double tube : {0.01, 0.25, 1.5}) {
    for (const double distance : {0.5, 5.0, 500.0, 5000.0, 50000.0}) {
      for (int i = 0; i < 40; ++i) {
        const Torus torus{1, tube, {}, {0, 0, 1}};
        const double angle = random.real(0, 6.283185307179586);
        const double beside = tube * random.real(-1.2, 1.2);
        const Vec3 target{(1 + beside) * std::cos(angle), (1 + beside) * std::sin(angle),
                          tube * random.real(-1.1, 1.1)};
        const Vec3 direction = random.direction();
        const LocalRay ray{target - distance * direction, direction, 1};
        const std::vector<double> found = crossingsOfTheLine(torus, ray);
        std::vector<double> exact;
        SturmChain(exactQuartic(torus, ray, distance)).collect(-4 * (1 + tube), 4 * (1 + tube), 1e-13, exact);
        for (double& t : exact) t += distance;
        if (grazes(exact, found, 1 + tube, distance)) {
          ++grazing;
          continue;
        }
        ASSERT_EQ(found.size(), exact.size()) << "tube " << tube << " distance " << distance << " ray " << i;
        for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], exact[k], 1e-3 * tube);
        crossed += !found.empty();
      }
    }
  }
  EXPECT_GT(crossed, 300);
  EXPECT_LT(grazing, 12);
}

// How far a point is from a torus around the z axis, its inner sheet included.
Wide root(Wide x) {
  Wide y = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 2 && y > 0; ++i) y = (y + x / y) / 2;
  return y;
}
double distanceTo(const Torus& torus, Vec3 p) {
  const Wide x = p.x, y = p.y, z = p.z, rho = root(x * x + y * y);
  const Wide near = root((rho - torus.swept) * (rho - torus.swept) + z * z);
  const Wide far = root((rho + torus.swept) * (rho + torus.swept) + z * z);
  return static_cast<double>(std::min(magnitude(near - torus.tube), magnitude(far - torus.tube)));
}

TEST(Torus, PointsAreOnTheSurfaceAndARayFromThereFindsTheWayOut) {
  SeededRandom random(2);
  for (const double tube : {1e-6, 1e-4, 0.01, 0.25, 1.5}) {
    const Torus torus{1, tube, {}, {0, 0, 1}};
    for (int i = 0; i < 300; ++i) {
      const double angle = random.real(0, 6.283185307179586);
      const Vec3 inside{std::cos(angle), std::sin(angle), tube * random.real(-0.7, 0.7)};
      const Vec3 direction = random.direction();
      const LocalRay ray{inside - 6 * direction, direction, 1};
      const double t = torus.intersect(ray, 0);
      ASSERT_NE(t, kNoHit);
      const ShapePoint at = torus.pointAt(ray, t);
      EXPECT_LE(distanceTo(torus, at.position), at.error);
      EXPECT_NEAR(length(at.geometricNormal), 1, 1e-15);
      EXPECT_LT(dot(at.geometricNormal, direction), 1e-3);
      // On along the same line, or straight inside: the surface that was just crossed is not there again.
      const Vec3 inward = -at.geometricNormal;
      const double exit = torus.intersect({at.position, inward, 1}, 4 * at.error);
      ASSERT_NE(exit, kNoHit) << "tube " << tube << " ray " << i;
      EXPECT_GT(exit, 0.1 * tube);
      const double again = torus.intersect({at.position, at.geometricNormal, 1}, 4 * at.error);
      EXPECT_TRUE(again == kNoHit || again > 0.01);
    }
  }
}

Wide densityAt(const Blob& blob, const LocalRay& ray, double t) {
  Wide sum = -static_cast<Wide>(blob.threshold);
  for (const Metaball& ball : blob.balls) {
    Wide squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Wide d = ray.origin[axis] + static_cast<Wide>(t) * ray.direction[axis] - ball.centre[axis];
      squared += d * d;
    }
    const Wide inside = 1 - squared / (static_cast<Wide>(ball.radius) * ball.radius);
    if (inside > 0) sum += ball.strength * inside * inside;
  }
  return sum;
}

Blob randomBlob(Random& random, int balls) {
  Blob blob{random.real(0.2, 0.9), {}};
  for (int i = 0; i < balls; ++i)
    blob.balls.push_back({random.point(-1, 1), random.real(0.3, 0.9), random.real(0.3, 1.5)});
  return blob;
}

TEST(Blob, CrossingsAreWhereTheDensityChangesSidesAndNowhereElse) {
  SeededRandom random(3);
  int hits = 0;
  for (int i = 0; i < 250; ++i) {
    const Blob blob = randomBlob(random, 1 + i % 9);
    const Vec3 direction = random.direction(), target = random.point(-1, 1);
    const double distance = i % 3 == 0 ? 3 : i % 3 == 1 ? 300 : 50000;
    const LocalRay ray{target - distance * direction, direction, 1};
    const std::vector<double> found = crossingsOfTheLine(blob, ray);
    hits += static_cast<int>(found.size());
    bool inside = false;
    std::size_t next = 0;
    for (int k = 0; k <= 150; ++k) {
      const double t = distance - 4 + 8 * k / 150.0;
      while (next < found.size() && found[next] < t) inside = !inside, ++next;
      const Wide density = densityAt(blob, ray, t);
      if (magnitude(density) < 1e-9) continue;
      ASSERT_EQ(density > 0, inside) << "ray " << i << " at " << t;
    }
    EXPECT_EQ(next, found.size());
    for (const double t : found) EXPECT_LT(magnitude(densityAt(blob, ray, t)), 1e-14 * (1 + distance) * 40);
  }
  EXPECT_GT(hits, 100);
}

TEST(Blob, PointsAreOnTheSkinWithinTheirError) {
  SeededRandom random(4);
  for (int i = 0; i < 400; ++i) {
    const Blob blob = randomBlob(random, 1 + i % 9);
    const Vec3 direction = random.direction(), target = random.point(-1, 1);
    const LocalRay ray{target - 40 * direction, direction, 1};
    const double t = blob.intersect(ray, 0);
    if (t == kNoHit) continue;
    const ShapePoint at = blob.pointAt(ray, t);
    EXPECT_LT(length(at.position - (ray.origin + t * direction)), 1e-10);
    EXPECT_LT(at.error, 1e-11);
    // `error` outside of the skin and inside of it the density is on different sides of the threshold.
    const LocalRay outward{at.position, at.geometricNormal, 1};
    EXPECT_LE(densityAt(blob, outward, at.error), 0);
    EXPECT_GE(densityAt(blob, outward, -at.error), 0);
    const double again = blob.intersect(outward, 4 * at.error);
    EXPECT_TRUE(again == kNoHit || again > 1e-6);
    const double exit = blob.intersect({at.position, -at.geometricNormal, 1}, 4 * at.error);
    EXPECT_NE(exit, kNoHit);
  }
}

TEST(HeightField, PointsAreOnTheTrianglesAndCrossingsAlternate) {
  SeededRandom random(5);
  const int size = 24;
  std::vector<float> values;
  for (int i = 0; i < size * size; ++i) values.push_back(static_cast<float>(random.real(-0.05, 0.05)));
  const HeightField field{makeHeights(size, values)};
  const double cells = size - 1;
  auto heightAt = [&](double x, double y) {  // by the definition of the two triangles of a cell
    const int i = std::min(static_cast<int>(x * cells), size - 2),
              j = std::min(static_cast<int>(y * cells), size - 2);
    const double u = x * cells - i, v = y * cells - j;
    auto z = [&](int dx, int dy) -> double {
      return values[static_cast<std::size_t>((j + dy) * size + i + dx)];
    };
    return u + v <= 1 ? z(0, 0) + u * (z(1, 0) - z(0, 0)) + v * (z(0, 1) - z(0, 0))
                      : z(1, 1) + (1 - u) * (z(0, 1) - z(1, 1)) + (1 - v) * (z(1, 0) - z(1, 1));
  };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from{random.real(0, 1), random.real(0, 1), 0.06},
        to{random.real(0, 1), random.real(0, 1), -0.06};
    const Vec3 direction = normalize(to - from);
    const double distance = i % 2 == 0 ? 0 : 1000;
    const LocalRay ray{from - distance * direction, direction, 1};
    const std::vector<double> found = crossingsOfTheLine(field, ray);
    EXPECT_EQ(found.size() % 2, 1u) << "from above the heights to below them";
    for (std::size_t k = 0; k < found.size(); ++k) {
      const ShapePoint at = field.pointAt(ray, found[k]);
      EXPECT_NEAR(at.position.z, heightAt(at.position.x, at.position.y), 1e-14);
      EXPECT_LT(length(at.position - (ray.origin + found[k] * direction)), 1e-15 * (10 + distance));
      EXPECT_EQ(dot(at.geometricNormal, direction) < 0, k % 2 == 0);
    }
  }
}

}  // namespace
}  // namespace rayshade
