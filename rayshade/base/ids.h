// Numbers that cannot be mixed up.
//
// Every family of things in a scene is numbered from 0 in the order of the file, so that the two passes over
// a scene and every program that reads it agree on the numbers without talking to each other.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rayshade {

enum class ObjectId : std::uint32_t {};      // a placed shape, CSG or instance
enum class NodeId : std::uint32_t {};        // a step of the naming tree; 0 is the root
enum class SurfaceId : std::uint32_t {};     // a surface as bound to objects
enum class DefinitionId : std::uint32_t {};  // objects that are kept together; 0 is the world

inline constexpr NodeId kRootNode{0};
inline constexpr DefinitionId kWorld{0};
inline constexpr SurfaceId kNoSurface{0xffffffffu};

template <class Id>
constexpr std::uint32_t number(Id id) {
  return static_cast<std::uint32_t>(id);
}

}  // namespace rayshade
