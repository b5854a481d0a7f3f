// What a texture is.
//
// A texture changes the surface or the normal of one hit.  It is plain data with one pure function; it knows
// nothing of shapes: positions and, for textures that are mapped, u, v and tangents come as values.
//
//   keyword    the word after `texture`
//   examples   what may follow it: tests and documents read them
//   parse      reads its own arguments (not the transforms behind them)
//   apply      changes `hit`
//   serialize  its fields, for the wire
//
// A texture that needs the mapped coordinates says `static constexpr bool mapped = true` and has a member
// `Mapping mapping`; then hit.u, hit.v, hit.dpdu and hit.dpdv are there when apply is called.  Others are
// spared the work. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <optional>
#include <string_view>

#include "rayshade/base/archive.h"
#include "rayshade/base/random.h"
#include "rayshade/base/vec.h"
#include "rayshade/optics/surface.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

// One hit as its textures see it.
struct TextureHit {
  Vec3 position;      // in the texture's own space
  Vec3 rayOrigin;     // in the texture's own space, for `cloud`                      (set only for mapped
                      // textures)
  Vec3 rayDirection;  // unit
  double
      u = 0,
      v = 0;  // after mapping and the texture's transforms                   (set only for mapped textures)
  Vec3 dpdu,
      dpdv;     // tangents in the space of `normal`                            (set only for mapped textures)
  Vec3 normal;  // unit, towards the viewer, in the space of the textured object's parent: may be changed
  Surface surface;  // may be changed
  RandomKey key{};  // of the ray
  int sample = 0;   // stratum: column sample % side, row sample / side
  int side = 1;     // samples per pixel along each side
};

template <class T>
concept Texture = requires(const T texture, TextureHit& hit, Arguments& arguments) {
  { T::keyword } -> std::convertible_to<std::string_view>;
  { T::mapped } -> std::convertible_to<bool>;
  { T::parse(arguments) } -> std::same_as<std::optional<T>>;
  texture.apply(hit);
  T::examples[0];
};

}  // namespace rayshade
