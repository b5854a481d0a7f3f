// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/placing.h"

#include "rayshade/intersect/ray_hit.h"

namespace rayshade {
namespace {

// How far from the point, along its normal in the world, the surface of a placed shape is at most.  `inside` leads into the shape's
// space, where a ray that starts at the point is off by `way`.
//
// A step of length s along the world's normal m, unit, leads g s off the surface, g being the length of the shape's unit normal n
// taken out, but also by h s along it.  Being off along the surface counts where it is curved, k: by k x^2 / 2.
double placedError(const ShapePoint& point, Vec3 normal, const Matrix& inside, Vec3 way) {
  const Vec3 n = point.geometricNormal;
  const double g = length(mapNormal(inside, n)), h = length(mapVector(inside, normal));
  const double across = point.error + std::abs(n.x) * way.x + std::abs(n.y) * way.y + std::abs(n.z) * way.z;
  const double along = way.x + way.y + way.z + 2 * h * across / g;
  const double bent = point.curvature > 0 ? std::min(along, point.curvature * along * along) : 0;
  return (across + bent) / g;
}

}  // namespace

Vec3 errorOfWay(std::span<const Affine> maps, Vec3 local, Vec3 outside) {
  Vec3 point = outside, error = kRounding * absolute(outside);
  for (std::size_t i = maps.size(); i-- > 0;) {
    const Matrix& in = maps[i].inverse;
    const Matrix sizes = absolute(in);
    error = mapVector(sizes, error) + kRounding * mapPoint(sizes, absolute(point));
    point = mapPoint(in, point);
  }
  return error + absolute(point - local);
}

PlacedPoint placedPoint(const Model& model, const HitPath& path, const Ray& ray, double t) {
  const SceneStore& store = model.store();
  PlacedPoint at;
  at.shape = pointAt(model, path.steps.back(), t);
  InlineVector<Affine, 4> maps;  // from the shape outwards
  for (std::size_t i = path.steps.size(); i-- > 0;) {
    const NodeIndex node = store.object(path.steps[i].object).node;
    if (store.node(node).identity) continue;
    maps.push_back(mapAt(store, node, ray.moment).value_or(Affine{}));
    at.toWorld = maps.size() == 1 ? maps.back() : then(at.toWorld, maps.back());
  }
  at.placed = !maps.empty() && !isIdentity(at.toWorld);
  at.position = at.placed ? mapPoint(at.toWorld.forward, at.shape.position) : at.shape.position;
  at.geometricNormal = at.placed ? normalize(mapNormal(at.toWorld.inverse, at.shape.geometricNormal))
                                 : at.shape.geometricNormal;
  at.error = at.shape.error;
  if (!maps.empty())
    at.error = placedError(at.shape, at.geometricNormal, at.toWorld.inverse,
                           errorOfWay({maps.data(), maps.size()}, at.shape.position, at.position));
  at.error += kRounding * maxAbs(at.position);
  return at;
}

bool endsIn(const Model& model, Vec3 origin, Vec3 direction, const Moment& moment, const Hit& hit,
            double end) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  ray.moment = moment;
  const PlacedPoint at = placedPoint(model, pathTo(model, ray, hit), ray, hit.t);
  const double behind = (end - hit.t) * std::abs(dot(direction, at.geometricNormal));
  return behind <= 2 * at.error + 12 * kRounding * (maxAbs(origin) + maxAbs(origin + end * direction));
}

}  // namespace rayshade
