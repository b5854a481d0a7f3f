// What a scene takes in the memory of a task that holds it: by this it is divided, and memory is asked for.
//
// Estimates, in bytes: of allocators only the usual surplus is known.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/scene/items.h"

namespace rayshade {

// An object that is placed, with its part of an accelerator, but without what it refers to.
std::uint64_t heldBytes(const SceneObject& object);
std::uint64_t heldBytes(const SceneNode& node);

inline constexpr std::uint64_t kTableEntryBytes = 48;  // of a hash table: number and index

// What a shape or a node holds outside of itself.
std::uint64_t bytesOutside(const AnyShape& shape);
std::uint64_t bytesOutside(const AllShapes::Vectors& shapes);
std::uint64_t bytesOutside(const SceneNode& node);
// Of pictures: they lie once on each machine, and in no task.
std::uint64_t imageBytes(const SceneNode& node);

}  // namespace rayshade
