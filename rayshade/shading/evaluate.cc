// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shading/evaluate.h"

#include "rayshade/intersect/placing.h"
#include "rayshade/intersect/ray_hit.h"
#include "rayshade/textures/apply.h"

namespace rayshade {
namespace {

// The way of a hit from the space of its shape up to the world, through the nodes one by one because the textures of
// each work in the space that it leads to.
class Climb {
 public:
  Climb(const Ray& ray, const PathStep& shape, const ShapePoint& point, const Surface& surface,
        const SamplePlan& plan)
      : moment_(ray.moment), shapeNormal_(point.geometricNormal) {
    hit_.surface = surface;
    hit_.normal = point.normal;
    hit_.key = ray.key;
    hit_.sample = ray.sample;
    hit_.depth = ray.depth;
    hit_.plan = plan;
    place_.position = point.position;
    place_.rayOrigin = shape.ray.origin;
    place_.rayDirection = shape.ray.direction;
  }

  // From the inside of a node to the space of its container.  `ofPrimitive` as for applyTexture().
  template <class OfPrimitive>
  void through(const SceneStore& store, NodeIndex index, const OfPrimitive& ofPrimitive) {
    for (; index != 0; index = store.node(index).parent) {
      const SceneNode& node = store.node(index).node;
      const Affine own = chainAt(node.transforms, moment_).value_or(Affine{});
      place_.object = then(place_.object, own);
      place_.position = mapPoint(own.forward, place_.position);
      place_.rayOrigin = mapPoint(own.forward, place_.rayOrigin);
      place_.rayDirection = mapVector(own.forward, place_.rayDirection);
      if (!node.transforms.empty()) hit_.normal = normalize(mapNormal(own.inverse, hit_.normal));
      place_.geometricNormal = shapeNormal_;
      for (const PlacedTexture& placed : node.textures) {
        place_.texture = chainAt(placed.transforms, moment_).value_or(Affine{});
        applyTexture(placed.texture, hit_, place_, ofPrimitive);
      }
    }
  }

  const TextureHit& hit() const { return hit_; }

 private:
  Moment moment_;
  Vec3 shapeNormal_;
  TextureHit hit_;
  TexturePlace place_;
};

// Turns the normals towards the viewer.  On interpolated normals that disagree with the surface itself about the side, the
// surface decides.  True: the ray comes from the side to which they point, and goes into the solid.
bool turnToViewer(ShapePoint& point, Vec3 direction) {
  double k = dot(direction, point.normal);
  const double g = dot(direction, point.geometricNormal);
  if ((k <= 0 && g > 0) || (k >= 0 && g < 0)) k = g;
  if (!(k > 0)) return k <= 0;
  point.normal = -point.normal;
  point.geometricNormal = -point.geometricNormal;
  return false;
}

}  // namespace

const Surface& boundSurface(const Model& model, const HitPath& path) {
  const SceneStore& store = model.store();
  for (std::size_t i = path.steps.size(); i-- > 0;) {
    const SurfaceIndex surface = store.object(path.steps[i].object).surface;
    if (surface != kNone) return store.surface(surface);
  }
  return store.surfaceOrDefault(kNone);
}

void evaluateSurface(const Model& model, const Hit& hit, const Ray& ray, const SceneSettings& settings,
                     SurfacePoint& at) {
  const SceneStore& store = model.store();
  const PlacedObject& object = store.object(hit.object);
  const PlacedNode& node = store.node(object.node);
  if (refersToDefinition(object.kind) || !node.identity || node.textured)
    return evaluateSurface(model, hit, pathTo(model, ray, hit), ray, settings, at);
  // The ordinary case, a shape of the world as it is: the same answers as below without a path.
  const LocalRay local{ray.origin, ray.direction, 1};
  ShapePoint point = withShape(store, object, [&](const auto& body) { return body.pointAt(local, hit.t); });
  at.smooth = point.normal != point.geometricNormal;
  at.entering = turnToViewer(point, ray.direction);
  at.position = point.position;
  at.normal = point.normal;
  at.geometricNormal = point.geometricNormal;
  at.error = point.error + kRounding * maxAbs(at.position);
  at.surface = store.surfaceOrDefault(object.surface);
}

void evaluateSurface(const Model& model, const Hit& hit, const HitPath& path, const Ray& ray,
                     const SceneSettings& settings, SurfacePoint& at) {
  const SceneStore& store = model.store();
  const PathStep& last = path.steps.back();
  PlacedPoint placed = placedPoint(model, path, ray, hit.t);
  ShapePoint& shapePoint = placed.shape;

  at.smooth = shapePoint.normal != shapePoint.geometricNormal;
  const bool outside = turnToViewer(shapePoint, last.ray.direction);
  at.entering = path.entering.value_or(outside);
  at.surface = boundSurface(model, path);
  const auto toWorld = [&](Vec3 normal) {
    return placed.placed ? normalize(mapNormal(placed.toWorld.inverse, normal)) : normal;
  };
  at.normal = toWorld(shapePoint.normal);
  bool textured = false;
  for (const PathStep& step : path.steps)
    textured = textured || store.node(store.object(step.object).node).textured;
  if (textured) {
    Climb climb(ray, last, shapePoint, at.surface, settings.samples);
    const auto ofPrimitive = [&](Vec3 position) {
      return withShape(store, store.object(last.object),
                       [&](const auto& shape) { return shape.coordinates(shapePoint, position); });
    };
    for (std::size_t i = path.steps.size(); i-- > 0;)
      climb.through(store, store.object(path.steps[i].object).node, ofPrimitive);
    at.surface = climb.hit().surface;
    at.normal = climb.hit().normal;
  }
  at.position = placed.position;
  at.geometricNormal = toWorld(shapePoint.geometricNormal);
  at.error = placed.error;
}

}  // namespace rayshade
