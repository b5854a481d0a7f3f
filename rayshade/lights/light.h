// What a light is.
//
// sampleLight() is asked twice for every hit - by the task that sends the shadow ray and again by the one
// that adds up the colours - and both get the same answer: the position, the key of the ray and its sample
// number say it all.
//
//   keyword    the word after the intensity
//   examples   what may follow it: tests and documents read them
//   parse      reads its own arguments
//   points     how many shadow rays one hit sends to it
//   sample     where point `index` of the light is, as seen from a position
//   extent     of lights whose points are random: the parallelogram that they lie in, as seen from a position
//   serialize  its fields, for the wire
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <optional>
#include <string_view>

#include "rayshade/base/archive.h"
#include "rayshade/base/bounds.h"
#include "rayshade/base/random.h"
#include "rayshade/base/vec.h"
#include "rayshade/sampling/sample_plan.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

// One point of a light seen from a position of the world.
struct LightSample {
  Vec3 toward;                        // unit, from the position to the light: decides the shading
  Vec3 shadowToward;                  // unit, the direction of the shadow ray (differs for `extended` alone)
  double shadowDistance = kInfinity;  // things nearer than this cast a shadow           [world units]
  double factor = 1;                  // share of the light's colour that goes this way
};

// World space.
struct LightExtent {
  Vec3 corner, edgeU, edgeV;
};

// What a light may know about the hit that asks.
struct LightQuery {
  Vec3 position;    // world
  RandomKey key{};  // of this light at this hit
  int sample = 0;   // number of the ray's sample
  SamplePlan plan{};
};

template <class L>
concept Light = Serializable<L> && requires(const L light, const LightQuery& query, Arguments& arguments) {
  { L::keyword } -> std::convertible_to<std::string_view>;
  { L::parse(arguments) } -> std::same_as<std::optional<L>>;
  { light.points() } -> std::same_as<int>;
  { light.sample(query, 0) } -> std::same_as<LightSample>;
  L::examples[0];
};
template <class L>
concept LightWithExtent = requires(const L light, Vec3 position) {
  { light.extent(position) } -> std::same_as<LightExtent>;
};

}  // namespace rayshade
