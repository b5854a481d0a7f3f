// What every shape must keep, asked of random shapes and random rays.
//
// Every type of AllShapes takes part with its examples and with random ones: those that this file has a make() for, or
// what comes of the examples when their numbers are changed at random.  So a new shape needs no edit here.  One for
// which there is a scaled() or an offSurface() (distance from the true surface, in long double) takes part in those
// demands, too.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <charconv>
#include <sstream>

#include "rayshade/shapes/all.h"
#include "tests/support/seeded_random.h"
#include "tests/support/text_arguments.h"

namespace rayshade {
namespace {

// ---------------------------------------------------------------------------------------------- randomness

class Dice : public SeededRandom {
 public:
  using SeededRandom::SeededRandom;
  double between(double low, double high) { return real(low, high); }
  Vec3 point(double least, double most) { return magnitude(least, most) * direction(); }
};

Vec3 anAxis(Dice& dice) { return dice.chance(0.3) ? Vec3{0, 0, 1} : dice.direction(); }
void make(Dice& dice, Sphere& s) { s = {dice.point(1e-3, 1e3), dice.magnitude(1e-3, 1e3)}; }
void make(Dice& dice, Box& b) {
  b.low = dice.point(1e-3, 1e3);
  b.high = b.low + Vec3{dice.magnitude(1e-3, 1e2), dice.magnitude(1e-3, 1e2), dice.magnitude(1e-3, 1e2)};
}
void make(Dice& dice, Plane& p) { p = {dice.point(1e-3, 1e3), normalize(anAxis(dice))}; }
void make(Dice& dice, Disc& d) {
  d = {dice.point(1e-3, 1e3), normalize(anAxis(dice)), dice.magnitude(1e-3, 1e3)};
}
void make(Dice& dice, Cylinder& c) {
  const Vec3 base = dice.point(1e-3, 1e3);
  const double radius = dice.magnitude(1e-2, 1e2);
  c.side = *frustumBetween(base, radius, base + dice.magnitude(1e-2, 1e2) * anAxis(dice), radius);
}
void make(Dice& dice, Cone& c) {
  const Vec3 base = dice.point(1e-3, 1e3);
  const double tip = dice.chance(0.5) ? 0 : dice.magnitude(1e-2, 1e2);
  c.side =
      *frustumBetween(base, dice.magnitude(1e-2, 1e2), base + dice.magnitude(1e-2, 1e2) * anAxis(dice), tip);
}
void make(Dice& dice, Triangle& t) {
  do {
    const Vec3 near = dice.point(1e-3, 1e3);
    for (Vec3& corner : t.corners) corner = near + dice.point(1e-3, 1e2);
  } while (!t.hasArea());
}
void make(Dice& dice, PhongTriangle& t) {
  make(dice, t.face);
  for (Vec3& n : t.normals) n = t.face.normal() + 0.4 * dice.direction();
}
void make(Dice& dice, TriangleUv& t) {
  make(dice, t.phong);
  for (auto& [u, v] : t.uv) {
    u = dice.between(-2, 2);
    v = dice.between(-2, 2);
  }
}
void make(Dice& dice, Polygon& p) {
  const Vec3 normal = normalize(anAxis(dice)), centre = dice.point(1e-3, 1e3);
  const auto [x, y] = basisAround(normal);
  const double size = dice.magnitude(1e-2, 1e2);
  std::ostringstream text;
  text.precision(17);
  for (int i = 0, n = int(dice.between(3, 12)); i < n; ++i) {  // a star around its centre: often concave
    const double turn = 6.283185307 * i / n, r = size * dice.between(0.2, 1);
    const Vec3 corner = centre + r * std::cos(turn) * x + r * std::sin(turn) * y;
    text << corner.x << ' ' << corner.y << ' ' << corner.z << ' ';
  }
  TextArguments in(text.str());
  if (std::optional<Polygon> made = Polygon::parse(in)) p = *made;
}

// The text of an example, each of its numbers changed by up to a quarter, or by as much of 1; words stay.
std::string varied(std::string_view example, Dice& dice) {
  std::istringstream in{std::string(example)};
  std::ostringstream out;
  out.precision(17);
  for (std::string word; in >> word;) {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      out << word << ' ';
    } else {
      out << value + 0.25 * dice.between(-1, 1) * (value != 0 ? value : dice.chance(0.5) ? 0 : 1) << ' ';
    }
  }
  return out.str();
}

// ------------------------------------------------------------------------------------- scaled by a power of two

Sphere scaled(const Sphere& s, double k) { return {k * s.centre, k * s.radius}; }
Box scaled(const Box& b, double k) { return {k * b.low, k * b.high}; }
Plane scaled(const Plane& p, double k) { return {k * p.point, p.normal}; }
Disc scaled(const Disc& d, double k) { return {k * d.centre, d.normal, k * d.radius}; }
Frustum scaled(const Frustum& f, double k) {
  return {k * f.base, f.axis, k * f.length, k * f.radius, k * f.endRadius};
}
Cylinder scaled(const Cylinder& c, double k) { return {scaled(c.side, k)}; }
Cone scaled(const Cone& c, double k) { return {scaled(c.side, k)}; }
Triangle scaled(const Triangle& t, double k) {
  return {{k * t.corners[0], k * t.corners[1], k * t.corners[2]}};
}
PhongTriangle scaled(const PhongTriangle& t, double k) { return {scaled(t.face, k), t.normals}; }
TriangleUv scaled(const TriangleUv& t, double k) { return {scaled(t.phong, k), t.uv}; }
Polygon scaled(Polygon p, double k) {
  for (Vec3& corner : p.corners) corner = k * corner;
  p.prepare();
  return p;
}

// -------------------------------------------------------------------------------- distance from the true surface

using Wide = long double;
struct WideVec {
  Wide x, y, z;
  WideVec(Wide x, Wide y, Wide z) : x(x), y(y), z(z) {}
  WideVec(Vec3 v) : x(v.x), y(v.y), z(v.z) {}
};
WideVec operator-(WideVec a, WideVec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
WideVec operator*(Wide s, WideVec a) { return {s * a.x, s * a.y, s * a.z}; }
Wide dot(WideVec a, WideVec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
WideVec cross(WideVec a, WideVec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Wide length(WideVec a) { return std::sqrt(dot(a, a)); }
Wide toSegment(WideVec p, WideVec a, WideVec b) {
  const WideVec edge = b - a;
  const Wide s = std::clamp<Wide>(dot(p - a, edge) / dot(edge, edge), 0, 1);
  return length(p - a - s * edge);
}

Wide offSurface(const Sphere& s, Vec3 p) { return std::abs(length(WideVec(p) - s.centre) - s.radius); }
Wide offSurface(const Box& b, Vec3 p) {
  Wide outside = 0, inside = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const Wide beyond = std::max(Wide(b.low[axis]) - p[axis], Wide(p[axis]) - b.high[axis]);
    outside += beyond > 0 ? beyond * beyond : 0;
    inside = std::min(inside, -beyond);
  }
  return outside > 0 ? std::sqrt(outside) : inside;
}
Wide toPlane(WideVec p, WideVec point, WideVec normal) {
  return std::abs(dot(p - point, normal)) / length(normal);
}
Wide offSurface(const Plane& s, Vec3 p) { return toPlane(p, s.point, s.normal); }
Wide offSurface(const Disc& s, Vec3 p) { return toPlane(p, s.centre, s.normal); }
Wide offSurface(const Frustum& s, Vec3 p) {  // to a segment in the plane of height and distance from the axis
  const WideVec from = WideVec(p) - s.base, axis = (1 / length(WideVec(s.axis))) * WideVec(s.axis);
  const Wide z = dot(from, axis);
  return toSegment({z, length(from - z * axis), 0}, {0, s.radius, 0}, {s.length, s.endRadius, 0});
}
Wide offSurface(const Cylinder& s, Vec3 p) { return offSurface(s.side, p); }
Wide offSurface(const Cone& s, Vec3 p) { return offSurface(s.side, p); }
Wide offSurface(const Triangle& s, Vec3 p) {
  const WideVec a = s.corners[0], b = s.corners[1], c = s.corners[2], normal = cross(b - a, c - a);
  auto left = [&](WideVec from, WideVec to) { return dot(cross(to - from, WideVec(p) - from), normal) >= 0; };
  if (left(a, b) && left(b, c) && left(c, a)) return toPlane(p, a, normal);
  return std::min({toSegment(p, a, b), toSegment(p, b, c), toSegment(p, c, a)});
}
Wide offSurface(const PhongTriangle& s, Vec3 p) { return offSurface(s.face, p); }
Wide offSurface(const TriangleUv& s, Vec3 p) { return offSurface(s.phong, p); }
Wide offSurface(const Polygon& s, Vec3 p) { return toPlane(p, s.corners[0], s.normal); }

// ----------------------------------------------------------------------------------------------- the demands

template <class S>
class EveryShape : public testing::Test {
 protected:
  // Its examples, and random ones: what this file makes, or else its examples varied.
  static std::vector<S> subjects() {
    std::vector<S> list;
    for (const std::string_view example : S::examples) read(example, list);
    Dice dice(1);
    if constexpr (requires(S & shape) { make(dice, shape); }) {
      for (int i = 0; i < 60; ++i) make(dice, list.emplace_back());
    } else {
      for (const std::string_view example : S::examples)
        for (int i = 0; i < 20; ++i) read(varied(example, dice), list);
    }
    return list;
  }
  static void read(std::string_view text, std::vector<S>& list) {
    TextArguments in(text);
    try {
      if (const std::optional<S> shape = S::parse(in)) list.push_back(*shape);
    } catch (const std::runtime_error&) {
      EXPECT_TRUE(in.namesFile()) << S::keyword << ' ' << text;  // the file need not be there
    }
  }

  // Most of them meet the shape: aimed at its extent from outside, from near, from inside.
  static std::vector<LocalRay> raysAt(const S& shape, std::uint64_t seed) {
    Dice dice(seed);
    Bounds b = shape.bounds();
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(b.low[axis])) b.low[axis] = -10;
      if (!std::isfinite(b.high[axis])) b.high[axis] = 10;
    }
    auto within = [&] {
      return Vec3{dice.between(b.low.x, b.high.x), dice.between(b.low.y, b.high.y),
                  dice.between(b.low.z, b.high.z)};
    };
    const double size = maxAbs(b.size());
    std::vector<LocalRay> rays;
    for (int i = 0; i < 200; ++i) {
      const Vec3 target = within();
      const Vec3 origin = i % 4 == 0 ? within() : target + size * dice.magnitude(0.1, 1e4) * dice.direction();
      Vec3 direction = normalize(target - origin);
      if (i % 8 == 7) direction = Vec3{0, 0, i % 16 == 7 ? 1.0 : -1.0};
      rays.push_back({origin, direction});
    }
    return rays;
  }

  // Calls use(shape, ray, t) for every hit; there must be some.
  template <class Use>
  static void forEveryHit(Use&& use) {
    std::uint64_t seed = 7;
    int hits = 0;
    for (const S& shape : subjects())
      for (const LocalRay& ray : raysAt(shape, ++seed)) {
        double t = 0;
        for (int count = 0; (t = shape.intersect(ray, t)) != kNoHit; ++count, ++hits) {
          ASSERT_LT(count, 1000) << "roots without end";
          use(shape, ray, t);
          if (testing::Test::HasFailure()) return;
        }
      }
    EXPECT_TRUE(hits > 50 || subjects().empty());
  }
};

template <class List>
struct AsTestTypes;
template <class... T>
struct AsTestTypes<TypeList<T...>> {
  using Types = testing::Types<T...>;
};
TYPED_TEST_SUITE(EveryShape, AsTestTypes<AllShapes>::Types);

TYPED_TEST(EveryShape, ItsExamplesAreReadToTheEnd) {
  for (const std::string_view example : TypeParam::examples) {
    TextArguments in(example);
    try {
      EXPECT_TRUE(TypeParam::parse(in)) << example;
      EXPECT_TRUE(in.allTaken()) << example;
      EXPECT_TRUE(in.warnings().empty()) << example;
    } catch (const std::runtime_error&) {
      EXPECT_TRUE(in.namesFile()) << example;
    }
  }
}
TYPED_TEST(EveryShape, ThereAreEnoughSubjects) {
  const std::vector<TypeParam> subjects = this->subjects();
  if (subjects.empty()) return;  // made of a file
  EXPECT_GE(subjects.size(), std::size(TypeParam::examples) + 15)
      << "`examples` of the shape `" << TypeParam::keyword
      << "` give too few shapes when their numbers change a little: change them, in the file of the shape";
}
TYPED_TEST(EveryShape, HitsLieOnTheSurfaceWithinTheErrorSaid) {
  this->forEveryHit([](const auto& shape, const LocalRay& ray, double t) {
    const ShapePoint at = shape.pointAt(ray, t);
    ASSERT_TRUE(isFinite(at.position) && at.error >= 0 && std::isfinite(at.error));
    if constexpr (requires { offSurface(shape, at.position); }) {
      ASSERT_LE(offSurface(shape, at.position), at.error);
    }
  });
}
TYPED_TEST(EveryShape, HitsLieInTheBounds) {
  this->forEveryHit([](const auto& shape, const LocalRay& ray, double t) {
    const Bounds b = padded(shape.bounds());
    ASSERT_TRUE(contains(b, shape.pointAt(ray, t).position));
    const Vec3 along = ray.origin + t * ray.direction;
    const double slack = kRounding * (maxAbs(ray.origin) + t);
    ASSERT_TRUE(overlap(b, {along - Vec3{slack, slack, slack}, along + Vec3{slack, slack, slack}}));
  });
}
TYPED_TEST(EveryShape, ThePointOfAHitIsWhereTheRayIs) {
  this->forEveryHit([](const auto& shape, const LocalRay& ray, double t) {
    const ShapePoint at = shape.pointAt(ray, t);
    const double off = length(cross(at.position - ray.origin, ray.direction));
    const double grazing = std::abs(dot(at.geometricNormal, ray.direction));
    const double size = maxAbs(ray.origin) + maxAbs(at.position);
    ASSERT_LE(off * std::min(1.0, grazing), 1e-12 * size) << t;
  });
}
TYPED_TEST(EveryShape, NormalsHaveLengthOne) {
  this->forEveryHit([](const auto& shape, const LocalRay& ray, double t) {
    const ShapePoint at = shape.pointAt(ray, t);
    ASSERT_NEAR(length(at.normal), 1, 1e-15);
    ASSERT_NEAR(length(at.geometricNormal), 1, 1e-15);
  });
}
TYPED_TEST(EveryShape, TangentsHaveLengthOneAndCoordinatesAreFinite) {
  this->forEveryHit([](const auto& shape, const LocalRay& ray, double t) {
    const ShapePoint at = shape.pointAt(ray, t);
    const SurfaceCoordinates c = shape.coordinates(at, at.position);
    ASSERT_TRUE(std::isfinite(c.u) && std::isfinite(c.v));
    ASSERT_NEAR(length(c.dpdu), 1, 1e-14);
    ASSERT_NEAR(length(c.dpdv), 1, 1e-14);
  });
}
TYPED_TEST(EveryShape, TheNextRootIsLargerAndRootsDoNotDependOnTheQuestion) {
  this->forEveryHit([](const auto& shape, const LocalRay& ray, double t) {
    ASSERT_GT(shape.intersect(ray, t), t);
    const double justBefore = std::nextafter(t, -kInfinity);
    ASSERT_EQ(shape.intersect(ray, justBefore), t);
    ASSERT_EQ(shape.intersect(ray, justBefore), t);  // and asking has changed nothing
  });
}
// What calls itself solid is entered and left in turn by a ray from outside, as CSG has it.
TYPED_TEST(EveryShape, ASolidIsEnteredAndLeftInTurn) {
  if (!TypeParam::solid || TypeParam::unbounded) return;
  std::uint64_t seed = 70;
  int left = 0;
  for (const TypeParam& shape : this->subjects())
    for (const LocalRay& ray : this->raysAt(shape, ++seed)) {
      if (contains(padded(shape.bounds()), ray.origin)) continue;
      bool inside = false, touched = false;
      for (double t = 0; (t = shape.intersect(ray, t)) != kNoHit && !touched;) {
        const double cosine = dot(shape.pointAt(ray, t).geometricNormal, ray.direction);
        touched = std::abs(cosine) < 1e-6;  // that may be either, or neither
        if (touched) continue;
        ASSERT_EQ(cosine > 0, inside) << t;
        left += inside;
        inside = !inside;
      }
      ASSERT_TRUE(touched || !inside);
    }
  EXPECT_GT(left, 50);
}
TYPED_TEST(EveryShape, EncodingADecodedOneGivesTheSameBytes) {
  for (const TypeParam& shape : this->subjects()) {
    const Bytes bytes = encode(shape);
    const std::optional<TypeParam> copy = decode<TypeParam>(bytes);
    ASSERT_TRUE(copy);
    ASSERT_EQ(encode(*copy), bytes);
    for (const LocalRay& ray : this->raysAt(shape, 3))
      ASSERT_EQ(shape.intersect(ray, 0), copy->intersect(ray, 0));
  }
}
TYPED_TEST(EveryShape, AnyBytesAreSurvived) {
  Dice dice(5);
  for (const TypeParam& shape : this->subjects()) {
    Bytes bytes = encode(shape);
    for (int i = 0; i < 20; ++i) {
      bytes[std::size_t(dice.between(0, double(bytes.size())))] = std::byte(int(dice.between(0, 256)));
      const std::optional<TypeParam> copy = decode<TypeParam>(bytes);
      if (!copy) continue;
      copy->bounds();
      for (const Vec3 direction : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}}) {
        const LocalRay ray{{0.1, 0.2, 0.3}, direction};
        const double t = copy->intersect(ray, 0);
        ASSERT_FALSE(std::isnan(t));
        if (t == kNoHit) continue;
        const ShapePoint at = copy->pointAt(ray, t);
        copy->coordinates(at, at.position);
      }
    }
  }
}
TYPED_TEST(EveryShape, ScaledWithItsRayByAPowerOfTwoItGivesTheSameBits) {
  if constexpr (requires(const TypeParam shape) { scaled(shape, 1.0); }) {
    for (const double k : {0x1p+20, 0x1p-20})
      this->forEveryHit([k](const auto& shape, const LocalRay& ray, double t) {
        const LocalRay large{k * ray.origin, ray.direction};
        const TypeParam other = scaled(shape, k);
        const double before = std::nextafter(t, 0.0);
        ASSERT_EQ(other.intersect(large, k * before), k * t);
        ASSERT_EQ(other.pointAt(large, k * t).position, k * shape.pointAt(ray, t).position);
        ASSERT_EQ(other.pointAt(large, k * t).normal, shape.pointAt(ray, t).normal);
      });
  }
}

}  // namespace
}  // namespace rayshade
