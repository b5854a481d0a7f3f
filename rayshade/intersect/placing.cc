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

Vec3 errorOfWay(const SceneStore& store, std::span<const NodeIndex> nodes, const Moment& moment, Vec3 local,
                Vec3 outside) {
  Vec3 point = outside, error = kRounding * absolute(outside);
  for (std::size_t i = nodes.size(); i-- > 0;) {
    const std::optional<Affine> map = mapAt(store, nodes[i], moment);
    if (!map) return {kInfinity, kInfinity, kInfinity};
    const Matrix& in = map->inverse;
    const Matrix sizes = absolute(in);
    error = mapVector(sizes, error) + kRounding * mapPoint(sizes, absolute(point));
    point = mapPoint(in, point);
  }
  return error + absolute(point - local);
}

PlacedPoint placedPoint(const Model& model, const HitPath& path, const Ray& ray, double t) {
  const SceneStore& store = model.store();
  const PathStep& last = path.steps.back();
  PlacedPoint at;
  at.shape = withShape(store, store.object(last.object),
                       [&](const auto& shape) { return shape.pointAt(last.ray, rootAt(model, last, t)); });
  InlineVector<NodeIndex, 8> nodes;  // that change the space, from the shape outwards
  for (std::size_t i = path.steps.size(); i-- > 0;) {
    const NodeIndex node = store.object(path.steps[i].object).node;
    if (store.node(node).identity) continue;
    const Affine map = mapAt(store, node, ray.moment).value_or(Affine{});
    at.toWorld = nodes.empty() ? map : then(at.toWorld, map);
    nodes.push_back(node);
  }
  at.placed = !nodes.empty() && !isIdentity(at.toWorld);
  at.position = at.placed ? mapPoint(at.toWorld.forward, at.shape.position) : at.shape.position;
  at.geometricNormal = at.placed ? normalize(mapNormal(at.toWorld.inverse, at.shape.geometricNormal))
                                 : at.shape.geometricNormal;
  at.error = at.shape.error;
  if (!nodes.empty())
    at.error = placedError(
        at.shape, at.geometricNormal, at.toWorld.inverse,
        errorOfWay(store, {nodes.data(), nodes.size()}, ray.moment, at.shape.position, at.position));
  at.error += kRounding * maxAbs(at.position);
  return at;
}

bool endsIn(const Model& model, const Ray& ray, const Hit& hit, double end) {
  const PlacedPoint at = placedPoint(model, pathTo(model, ray, hit), ray, hit.t);
  const double behind = (end - hit.t) * std::abs(dot(ray.direction, at.geometricNormal));
  return behind <=
         2 * at.error + 12 * kRounding * (maxAbs(ray.origin) + maxAbs(ray.origin + end * ray.direction));
}

}  // namespace rayshade
