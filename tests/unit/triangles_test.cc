// Known values of triangles and polygons, meshes without leaks, and the hard numerical cases.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "rayshade/shapes/polygon.h"
#include "rayshade/shapes/sphere.h"
#include "rayshade/shapes/triangle.h"
#include "rayshade/shapes/triangle_uv.h"
#include "tests/support/near.h"
#include "tests/support/shape_subjects.h"

namespace rayshade {
namespace {

struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> faces;

  Triangle face(std::size_t i) const {
    return {{vertices[faces[i][0]], vertices[faces[i][1]], vertices[faces[i][2]]}};
  }
};

// A closed sphere of radius 1: `rings` rows of `rings` quadrilaterals, closed by fans at the poles.
Mesh sphereMesh(int rings, Vec3 centre, double radius = 1) {
  Mesh mesh;
  mesh.vertices = {centre + Vec3{0, 0, -radius}, centre + Vec3{0, 0, radius}};
  auto at = [rings](int row, int column) { return 2 + row * rings + column % rings; };
  for (int row = 0; row + 1 < rings; ++row)
    for (int column = 0; column < rings; ++column) {
      const double theta = std::numbers::pi * (row + 1) / rings, phi = 2 * std::numbers::pi * column / rings;
      mesh.vertices.push_back(centre + radius * Vec3{std::sin(theta) * std::cos(phi),
                                                     std::sin(theta) * std::sin(phi), -std::cos(theta)});
    }
  for (int column = 0; column < rings; ++column) {
    mesh.faces.push_back({0, at(0, column + 1), at(0, column)});
    mesh.faces.push_back({1, at(rings - 2, column), at(rings - 2, column + 1)});
    for (int row = 0; row + 2 < rings; ++row) {
      mesh.faces.push_back({at(row, column), at(row, column + 1), at(row + 1, column + 1)});
      mesh.faces.push_back({at(row, column), at(row + 1, column + 1), at(row + 1, column)});
    }
  }
  return mesh;
}

// Rays from inside a closed mesh at every vertex and every edge midpoint; only the faces around the target and
// their neighbours are asked.
int leaks(const Mesh& mesh, Vec3 origin) {
  std::vector<std::vector<std::size_t>> around(mesh.vertices.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const int v : mesh.faces[f]) around[v].push_back(f);
  auto hit = [&](const LocalRay& ray, std::initializer_list<int> near) {
    for (const int v : near)
      for (const std::size_t f : around[v])
        if (mesh.face(f).intersect(ray, 0) != kNoHit) return true;
    return false;
  };
  int leaked = 0;
  for (int v = 0; v < int(mesh.vertices.size()); ++v) leaked += !hit(rayTo(origin, mesh.vertices[v]), {v});
  for (const auto& face : mesh.faces)
    for (int i = 0; i < 3; ++i) {
      const int a = face[i], b = face[(i + 1) % 3];
      leaked += !hit(rayTo(origin, mesh.vertices[a] * 0.5 + mesh.vertices[b] * 0.5), {a, b});
    }
  return leaked;
}

TEST(Triangle, ClosedMeshDoesNotLeakAtVerticesAndEdges) {
  const Mesh mesh = sphereMesh(60, {0, 0, 0});
  EXPECT_EQ(leaks(mesh, {0, 0, 0}), 0);
  EXPECT_EQ(leaks(mesh, {0.1, -0.2, 0.3}), 0);
  EXPECT_EQ(leaks(mesh, {0.7, 0.1, -0.5}), 0);
}
TEST(Triangle, ClosedMeshDoesNotLeakFarFromTheOrigin) {
  for (const Vec3 centre : {Vec3{148376, 1234, -223423}, Vec3{1e9, 1e9, -1e9}}) {
    const Mesh mesh = sphereMesh(60, centre);
    EXPECT_EQ(leaks(mesh, centre), 0);
    EXPECT_EQ(leaks(mesh, centre + Vec3{0.1, -0.2, 0.3}), 0);
  }
}
TEST(Triangle, SmallTrianglesAreHitFromAMillionAway) {
  int wrong = 0;
  for (int row = 0; row < 100; row += 3)
    for (int column = 0; column < 100; column += 3)
      for (const Vec3 origin : {Vec3{1e6, 2e5, 1e6}, Vec3{-1e6, 3, 1e6}, Vec3{7, -1e6, -1e6}}) {
        const double x = column, y = row;
        const Triangle lower{{{{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}}}};
        const Triangle upper{{{{x, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}}}};
        const LocalRay ray = rayTo(origin, {x + 2 / 3.0, y + 1 / 3.0, 0});
        wrong += lower.intersect(ray, 0) == kNoHit;
        wrong += upper.intersect(ray, 0) != kNoHit;
      }
  EXPECT_EQ(wrong, 0);
}
TEST(Triangle, WithoutAreaIsRefusedAndIsNeverHit) {
  EXPECT_TRUE(
      refused<Triangle>("-1113.45459 -79.049614 -56.2431908 -1113.45459 -87.0922699 -56.2431908 "
                        "-1113.45459 -79.2090149 -56.2431908"));
  const Triangle line{{{{-1113.45459, -79.049614, -56.2431908},
                        {-1113.45459, -87.0922699, -56.2431908},
                        {-1113.45459, -79.2090149, -56.2431908}}}};
  EXPECT_EQ(line.intersect(rayTo({-1081.47925, 99.9999542, 87.7701111}, {-1113.45459, -80, -56.2431908}), 0),
            kNoHit);
  EXPECT_TRUE(refused<Triangle>("0 0 0  1 2 3  2 4 6"));
  EXPECT_TRUE(refused<Triangle>("0.1 0.1 0.1  0.2 0.2 0.2  0.7 0.7 0.7"));
  EXPECT_TRUE(refused<Triangle>("5 5 5  5 5 5  1 0 0"));
}

// Does the exact ray meet the triangle?  In 113 bits; |determinants| have relative errors near 1e-30.
bool exactlyMeets(const Triangle& triangle, const LocalRay& ray) {
  using Wide = __float128;
  struct W3 {
    Wide x, y, z;
  };
  auto from = [&](Vec3 p) {
    return W3{Wide(p.x) - ray.origin.x, Wide(p.y) - ray.origin.y, Wide(p.z) - ray.origin.z};
  };
  auto volume = [&](const W3& a, const W3& b) {
    return ray.direction.x * (a.y * b.z - a.z * b.y) + ray.direction.y * (a.z * b.x - a.x * b.z) +
           ray.direction.z * (a.x * b.y - a.y * b.x);
  };
  const W3 a = from(triangle.corners[0]), b = from(triangle.corners[1]), c = from(triangle.corners[2]);
  const Wide u = volume(b, c), v = volume(c, a), w = volume(a, b);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

TEST(Triangle, SkinnyAndGrazedIsNotHitFarFromItself) {
  const Vec3 a{0, 0, 0}, b{11.2, 0, 0};  // sides 11.2, 9.7, 1.6: as skinny as a triangle can be
  const double x = (11.2 * 11.2 + 9.7 * 9.7 - 1.6 * 1.6) / (2 * 11.2);
  const Triangle triangle{{{a, b, {x, std::sqrt(9.7 * 9.7 - x * x), 0}}}};
  int misses = 0, hits = 0;
  for (int i = 0; i < 20000; ++i) {  // 0.52 degrees to the plane, from 12291 away
    const double turnAngle = i * 0.61803, tilt = 0.52 / 180 * std::numbers::pi;
    const Vec3 d{std::cos(turnAngle) * std::cos(tilt), std::sin(turnAngle) * std::cos(tilt), -std::sin(tilt)};
    const Vec3 target{12.0 * (i % 97) / 97 - 0.4, 0.7 * (i % 89) / 89 - 0.1, 0};
    const LocalRay ray = {target - 12291.0 * d, d};
    const double t = triangle.intersect(ray, 0);
    ASSERT_EQ(t != kNoHit, exactlyMeets(triangle, ray)) << i;
    (t == kNoHit ? misses : hits) += 1;
    if (t != kNoHit) {
      ASSERT_NEAR(t, 12291, 1e-7);
    }
  }
  EXPECT_GT(misses, 1000);
  EXPECT_GT(hits, 1000);
}
TEST(Triangle, NeedleIsHitAtItsCentroid) {
  const Triangle needle = made<Triangle>("0 0 0  1e6 1 0  1e6 0 0");
  const Vec3 centroid = (needle.corners[0] + needle.corners[1] + needle.corners[2]) / 3;
  for (const Vec3 origin : {Vec3{0, 0, 5}, Vec3{1e6, -1e6, 1e3}, Vec3{-3, 2, -1e7}})
    EXPECT_NE(needle.intersect(rayTo(origin, centroid), 0), kNoHit);
}
TEST(Triangle, CoincidentTrianglesGiveTheSameT) {
  const Triangle one{{{{0.1, 0.2, 0.3}, {4, 0.7, 1}, {-1, 3, 2}}}}, same = one;
  const LocalRay ray = rayTo({1, 1, 9}, {0.8, 1.1, 1});
  EXPECT_NE(one.intersect(ray, 0), kNoHit);
  EXPECT_EQ(one.intersect(ray, 0), same.intersect(ray, 0));
}
TEST(Triangle, RayInItsPlaneIsAMiss) {
  const Triangle level = made<Triangle>("0 0 0  1 0 0  0 1 0"),
                 oblique = made<Triangle>("1 0 0  0 1 0  0 0 1");
  EXPECT_EQ(level.intersect(rayFrom({-1, 0.25, 0}, {1, 0.125, 0}), 0), kNoHit);
  EXPECT_EQ(level.intersect(rayFrom({-1, 0, 0}, {1, 0, 0}), 0), kNoHit);
  EXPECT_EQ(oblique.intersect(rayFrom({1, 0, 0}, {-1, 1, 0}), 0), kNoHit);
}
TEST(Triangle, AnEdgeThatIsMetExactlyIsOneCrossing) {
  // The octahedron has faces in eight octants, so that rays square to an axis meet edges and corners exactly.
  Mesh octahedron{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, {}};
  for (const int x : {0, 1})
    for (const int y : {2, 3})
      for (const int z : {4, 5}) octahedron.faces.push_back({x, y, z});
  auto crossings = [&](const LocalRay& ray) {
    std::set<double> distances;
    for (std::size_t f = 0; f < octahedron.faces.size(); ++f) {
      const double t = octahedron.face(f).intersect(ray, 0);
      if (t != kNoHit) distances.insert(t);
    }
    return distances;
  };
  EXPECT_EQ(crossings({{-3, 0.1, 0.3}, {1, 0, 0}}).size(), 2u);             // faces only
  EXPECT_EQ(crossings({{-3, 0, 0.3}, {1, 0, 0}}).size(), 2u);               // edges
  EXPECT_EQ(crossings({{-3, 0, 0}, {1, 0, 0}}), (std::set<double>{2, 4}));  // corners
  EXPECT_EQ(crossings({{-3, 0.7, 0}, {1, 0, 0}}).size(), 2u);
  EXPECT_EQ(crossings({{0.3, 0, -7}, {0, 0, 1}}).size(), 2u);
  EXPECT_EQ(crossings(rayFrom({-3, 0, 0.3}, {3, 0.1, 0})).size(),
            2u);  // in through an edge, out through a face
}
TEST(Triangle, OfExtremeSizeIsRightOrRefused) {
  EXPECT_TRUE(refused<Triangle>("0 0 0  1e-160 0 0  0 1e-160 0"));
  EXPECT_TRUE(refused<Triangle>("0 0 0  1e200 0 0  0 1e200 0"));
  const Triangle huge = made<Triangle>("0 0 0  1e150 0 0  0 1e150 0");
  EXPECT_NEAR(huge.intersect({{1e149, 1e149, 1e150}, {0, 0, -1}}, 0) / 1e150, 1, 1e-15);
  const Triangle tiny = made<Triangle>("0 0 0  1e-140 0 0  0 1e-140 0");
  EXPECT_NEAR(tiny.intersect({{1e-141, 1e-141, 1e-140}, {0, 0, -1}}, 0) / 1e-140, 1, 1e-15);
  EXPECT_EQ(tiny.normal(), (Vec3{0, 0, 1}));
  EXPECT_TRUE(refused<Triangle>("0 0 0  inf 0 0  0 1 0"));
  EXPECT_TRUE(refused<Triangle>("0 0 0  nan 0 0  0 1 0"));
}
TEST(Triangle, NoLeakAtAVertexExactlyOnTheNeighboursEdge) {
  const Vec3 a{-1, 0, 0}, b{1, 0, 0}, m{0.25, 0, 0};
  const Triangle large{{{a, b, {0, -1, 0}}}}, left{{{a, {0, 1, 0}, m}}}, right{{{m, {0, 1, 0}, b}}};
  for (int i = -64; i <= 64; ++i) {
    const LocalRay ray{{i / 64.0, 0, 5}, {0, 0, -1}};
    EXPECT_EQ(large.intersect(ray, 0), 5);
    EXPECT_EQ(std::min(left.intersect(ray, 0), right.intersect(ray, 0)), 5);
  }
}

TEST(Triangle, TheTurnOfAnEdgeHasItsExactSign) {
  const double e = 0x1p-30;
  const ShearedPoint a{1 + e, 1}, b{1, 1 - e};  // (1 + e)(1 - e) - 1 = -e^2, and the product rounds to 1
  EXPECT_EQ(turn(a, b), -e * e);
  EXPECT_EQ(turn(b, a), e * e);
  EXPECT_EQ(turn(a, a), 0);
}
TEST(Triangle, KnownHitNormalAndCoordinates) {
  const Triangle triangle = made<Triangle>("0 0 0  4 0 0  0 4 0");
  const LocalRay ray{{1, 2, 3}, {0, 0, -1}};
  ASSERT_EQ(triangle.intersect(ray, 0), 3);
  const ShapePoint at = triangle.pointAt(ray, 3);
  EXPECT_EQ(at.position, (Vec3{1, 2, 0}));
  EXPECT_EQ(at.normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(at.local, (Vec3{0.25, 0.25, 0.5}));
  const SurfaceCoordinates c = triangle.coordinates(at, at.position);
  EXPECT_EQ(c.v, 0.5);
  EXPECT_EQ(c.u, 0.5);
  EXPECT_EQ(c.dpdu, (Vec3{1, 0, 0}));
  expectNear(c.dpdv, normalize({-1, -2, 0}));
  EXPECT_EQ(triangle.intersect(ray, 3), kNoHit);
  EXPECT_EQ(triangle.intersect({{1, 2, -3}, {0, 0, -1}}, 0), kNoHit);
}
TEST(Triangle, FlippedTurnsTheNormalOnly) {
  const Triangle triangle = made<Triangle>("0 0 0  4 0 0  0 4 1");
  expectNear(triangle.flipped().normal(), -triangle.normal());
  const LocalRay ray = rayTo({1, 1, 9}, {1, 1, 0.25});
  EXPECT_NEAR(triangle.flipped().intersect(ray, 0), triangle.intersect(ray, 0), 1e-14);
}
TEST(Triangle, NineNumbersMakeAFlatOneAndEighteenAPhongOne) {
  TextArguments nine(Triangle::examples[0]), eighteen(PhongTriangle::examples[0]);
  const auto flat = parseTriangle(nine), phong = parseTriangle(eighteen);
  ASSERT_TRUE(flat && phong);
  EXPECT_TRUE(std::holds_alternative<Triangle>(*flat));
  ASSERT_TRUE(std::holds_alternative<PhongTriangle>(*phong));
  const PhongTriangle asParsed = made<PhongTriangle>(PhongTriangle::examples[0]);
  EXPECT_EQ(std::get<PhongTriangle>(*phong).face.corners, asParsed.face.corners);
  EXPECT_EQ(std::get<PhongTriangle>(*phong).normals, asParsed.normals);
  EXPECT_TRUE(nine.allTaken() && eighteen.allTaken());
}
TEST(PhongTriangle, InterpolatesTheNormals) {
  const PhongTriangle triangle = made<PhongTriangle>(PhongTriangle::examples[0]);
  const LocalRay ray{{0.25, 0.5, 1}, {0, 0, -1}};
  const ShapePoint at = triangle.pointAt(ray, triangle.intersect(ray, 0));
  const double half = std::sqrt(0.5);  // given normals count by their direction, not by their length
  expectNear(at.normal, normalize({0.25 * half, 0.5 * half, 0.25 + 0.75 * half}));
  EXPECT_EQ(at.geometricNormal, (Vec3{0, 0, 1}));
  expectNear(triangle.flipped().pointAt(ray, 1).normal, -at.normal);
  EXPECT_EQ(triangle.flipped().pointAt(ray, 1).geometricNormal, (Vec3{0, 0, -1}));
}
TEST(PhongTriangle, TheNormalsWinOverTheOrderOfTheCorners) {
  TextArguments in("0 0 0  0 0 -1  1 0 0  0 0 -1  0 1 0  0 0 -1");
  const auto triangle = PhongTriangle::parse(in);
  EXPECT_EQ(in.warnings().size(), 1u);
  EXPECT_EQ(triangle->pointAt({{0.25, 0.25, 1}, {0, 0, -1}}, 1).geometricNormal, (Vec3{0, 0, -1}));
}
TEST(TriangleUv, InterpolatesItsCoordinatesAndHasTheirTangents) {
  const TriangleUv triangle =
      made<TriangleUv>("0 0 0  0 0 1  0.5 0   2 0 0  0 0 1  0.5 1   0 2 0  0 0 1  1.5 0");
  const LocalRay ray{{0.5, 1, 1}, {0, 0, -1}};  // weights 1/4 1/4 1/2
  const ShapePoint at = triangle.pointAt(ray, 1);
  const SurfaceCoordinates c = triangle.coordinates(at, at.position);
  EXPECT_EQ(c.u, 1);
  EXPECT_EQ(c.v, 0.25);
  EXPECT_EQ(c.dpdu, (Vec3{0, 1, 0}));  // u grows with y, v with x
  EXPECT_EQ(c.dpdv, (Vec3{1, 0, 0}));
}

TEST(Polygon, CornerAndSelfCrossingStarFollowTheNonZeroRule) {
  const Polygon star =
      made<Polygon>("0 4 0  -2 -3 0  4 1 0  -4 1 0  2 -3 0");  // five points, drawn in one line
  auto hit = [&](double x, double y) { return star.intersect({{x, y, 1}, {0, 0, -1}}, 0) == 1; };
  EXPECT_TRUE(hit(0, 0));  // wound around twice
  EXPECT_TRUE(hit(0, 2));
  EXPECT_TRUE(hit(0, 4));  // corners
  EXPECT_TRUE(hit(-4, 1));
  EXPECT_TRUE(hit(3, 1));  // a level edge
  EXPECT_FALSE(hit(4.5, 1));
  EXPECT_FALSE(hit(-4.5, 1));
  EXPECT_FALSE(hit(0, -3));  // between two points of the star
  EXPECT_FALSE(hit(2, 2));
  EXPECT_FALSE(hit(1, 4));  // level with a corner
}
TEST(Polygon, ConcaveWithARayLevelWithItsCorners) {
  const Polygon notched = made<Polygon>("0 0 1  4 0 1  4 4 1  2 1 1  0 4 1");
  auto hit = [&](double x, double y) { return notched.intersect({{x, y, 0}, {0, 0, 1}}, 0) == 1; };
  EXPECT_TRUE(hit(0.5, 1));
  EXPECT_TRUE(hit(3.5, 1));
  EXPECT_TRUE(hit(2, 0.5));
  EXPECT_TRUE(hit(2, 1));
  EXPECT_TRUE(hit(0, 2));
  EXPECT_TRUE(hit(4, 4));
  EXPECT_FALSE(hit(2, 2));
  EXPECT_FALSE(hit(-1, 1));
  EXPECT_FALSE(hit(5, 1));
  EXPECT_FALSE(hit(5, 4));
  EXPECT_FALSE(hit(2, 4));
}
TEST(Polygon, FrontIsWhereTheCornersRunCounterClockwise) {
  const Polygon square = made<Polygon>("0 0 0  1 0 0  1 1 0  0 1 0");
  EXPECT_EQ(square.normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(square.flipped().normal, (Vec3{0, 0, -1}));
  const SurfaceCoordinates c = square.coordinates({}, {0.25, 0.5, 0});
  EXPECT_EQ(c.u, 0.25);
  EXPECT_EQ(c.v, 0.5);
}
TEST(Polygon, WhoseLobesCancelIsDrawn) {
  const Polygon bow = made<Polygon>("-1 -1 0  1 1 0  1 -1 0  -1 1 0");
  EXPECT_EQ(bow.normal, (Vec3{0, 0, -1}));  // from the first three corners, in their order
  auto hits = [](const Polygon& polygon, double x, double y) {
    return polygon.intersect({{x, y, 5}, {0, 0, -1}, 1}, 0) == 5;
  };
  EXPECT_TRUE(hits(bow, 0.8, 0.1) && hits(bow, -0.8, 0.1));
  EXPECT_FALSE(hits(bow, 0.1, 0.8) || hits(bow, 0.1, -0.8));
  // Slanted, so that the sum is rounding and not 0.
  const Polygon slanted = made<Polygon>("0.1 0.3 0.7  0.4 0.6 0.8  0.4 0.3 0.7  0.1 0.6 0.8");
  EXPECT_LT(length(slanted.normal - normalize(Vec3{0, 1, -3})), 1e-15);
  EXPECT_FALSE(slanted.bent);
}

TEST(Polygon, WithoutAreaIsRefusedAndABentOneIsReported) {
  EXPECT_TRUE(refused<Polygon>("0 0 0  1 1 1  2 2 2  3 3 3"));
  EXPECT_TRUE(refused<Polygon>("0.1 0.1 0.1  0.3 0.3 0.3  0.7 0.7 0.7"));
  EXPECT_FALSE(refused<Polygon>("0 0 0  1e-9 0 0  0 1e-9 0"));
  EXPECT_ANY_THROW(refused<Polygon>("0 0 0  1 1 1"));
  TextArguments bent("0 0 0  1 0 0  1 1 0.5  0 1 0"), flat("0 0 0  1 0 0  1 1 0  0 1 0");
  EXPECT_TRUE(Polygon::parse(bent) && Polygon::parse(flat));
  EXPECT_EQ(bent.warnings().size(), 1u);
  EXPECT_TRUE(flat.warnings().empty());
}
TEST(Polygon, SlightlyBentOnesThatShareAnEdgeHaveNoHoleBetweenThem) {
  // As bent as rounded decimals make them; visibly bent ones look as in rayshade, holes included.
  const Polygon left = made<Polygon>("0 0 0  1 0 0.00001  1 1 0.00003  0 1 -0.00001");
  const Polygon right = made<Polygon>("1 1 0.00003  1 0 0.00001  2 0 0  2 1 0.000005");
  EXPECT_FALSE(left.bent || right.bent);
  for (int i = 1; i < 1000; ++i) {
    const LocalRay ray = rayTo({0.3, -2, 5}, {1, i / 1000.0, 0.00001 + 0.00002 * i / 1000});
    EXPECT_TRUE(left.intersect(ray, 0) != kNoHit || right.intersect(ray, 0) != kNoHit) << i;
  }
}

}  // namespace
}  // namespace rayshade
