// What a texture is.
//
// A texture changes the surface or the normal of one hit.  It is plain data with one pure function; it knows
// nothing of shapes: where the hit lies comes as values.
//
//   keyword           the word after `texture`
//   needs             which fields of the hit it reads; the others are not computed for it
//   makesTransparent  it may let rays through where the surface does not: plans count on it
//   examples          what may follow the keyword: tests and documents read them
//   parse             reads its own arguments (not the transforms behind them)
//   otherSurface      the surface that it may put in the place of the object's, or null: plans count on it
//   apply             changes `hit`
//   serialize         its fields, for the wire
//
// applyTexture() in textures/apply.h calls a texture with the fields that it needs.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <concepts>
#include <optional>
#include <string_view>

#include "rayshade/base/archive.h"
#include "rayshade/base/random.h"
#include "rayshade/base/vec.h"
#include "rayshade/optics/surface.h"
#include "rayshade/sampling/sample_plan.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

// All textures get the position; those that need coordinates have a member `Mapping mapping`.
enum class TextureNeeds : std::uint8_t { position, coordinates, ray };

// One hit as its textures see it.
//
// The textured frame's parent space is the space behind the transforms of the frame that the texture stands
// at; texture space is what the inverse of the texture's own transforms makes of it.
struct TextureHit {
  // What the textures of all levels pass on to each other.
  Surface surface;  // may be changed
  Vec3 normal;      // shading, towards the viewer, parent space, unit: may be changed, also in length
  RandomKey key{};  // of the ray
  int sample = 0;   // number of the ray's sample
  int depth = 0;    // of the ray
  SamplePlan plan{};
  std::uint32_t turn = 0;  // how many textures were here before: sets their random numbers apart

  // What applyTexture() sets for each texture anew.
  Vec3 position;        // texture space
  double u = 0, v = 0;  // after the mapping and the texture's transforms       (TextureNeeds::coordinates)
  Vec3 dpdu, dpdv;      // tangents, unit or 0, space of `normal`               (TextureNeeds::coordinates)
  Vec3 rayOrigin, rayDirection;  // primitive's space, direction unit                    (TextureNeeds::ray)
};

template <class T>
concept Texture = Serializable<T> && requires(const T texture, TextureHit& hit, Arguments& arguments) {
  { T::keyword } -> std::convertible_to<std::string_view>;
  { T::needs } -> std::convertible_to<TextureNeeds>;
  { T::makesTransparent } -> std::convertible_to<bool>;
  { T::parse(arguments) } -> std::same_as<std::optional<T>>;
  { texture.otherSurface() } -> std::same_as<const Surface*>;
  texture.apply(hit);
  T::examples[0];
};

// The unit normal that a bump makes of one; the old one where nothing sensible would be left of it.
inline Vec3 bend(Vec3 normal, Vec3 by) {
  const Vec3 bent = normalize(normal + by);
  return isFinite(bent) && bent != Vec3{} ? bent : normal;
}

// The bump of a height that rises by these slopes along the tangents: where dpdu, dpdv and the normal are
// right-handed, the normal leans downhill.
inline Vec3 bendAlongTangents(const TextureHit& hit, double slopeU, double slopeV) {
  return bend(hit.normal, slopeU * cross(hit.normal, hit.dpdv) - slopeV * cross(hit.normal, hit.dpdu));
}

// NaN becomes 0.
inline double unitInterval(double x) { return x > 0 ? std::min(x, 1.0) : 0.0; }

inline void scaleAmbientAndDiffuse(Surface& surface, Color by) {
  surface.ambient = surface.ambient * by;
  surface.diffuse = surface.diffuse * by;
}
inline void scaleAmbientAndDiffuse(Surface& surface, double by) {
  by = std::clamp(by, -kMostLight, kMostLight);  // a fractal knows no bounds
  scaleAmbientAndDiffuse(surface, Color{by, by, by});
}

}  // namespace rayshade
