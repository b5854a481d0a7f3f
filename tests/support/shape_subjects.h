// Shapes from words, rays at them, and where they cross.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "rayshade/shapes/shape.h"
#include "tests/support/text_arguments.h"

namespace rayshade {

inline LocalRay rayFrom(Vec3 origin, Vec3 direction) { return {origin, normalize(direction)}; }
inline LocalRay rayTo(Vec3 origin, Vec3 target) { return rayFrom(origin, target - origin); }

template <class S>
std::optional<S> parsed(std::string_view text) {
  TextArguments in(text);
  return S::parse(in);
}
template <class S>
S made(std::string_view text) {
  TextArguments in(text);
  const std::optional<S> shape = S::parse(in);
  if (!shape || !in.allTaken()) throw std::runtime_error("not a shape: " + std::string(text));
  return *shape;
}
template <class S>
bool refused(std::string_view text) {
  return !parsed<S>(text);
}

// All t after tMin at which the ray crosses the shape, a hundred at most.
using Crossings = std::vector<double>;
template <class S>
Crossings crossings(const S& shape, const LocalRay& ray, double tMin = 0) {
  Crossings all;
  for (double t = shape.intersect(ray, tMin); t != kNoHit && all.size() < 100; t = shape.intersect(ray, t))
    all.push_back(t);
  return all;
}
template <class S>
Crossings crossingsOfTheLine(const S& shape, const LocalRay& ray) {
  return crossings(shape, ray, -1e300);
}

}  // namespace rayshade
