// Scenes to try things on: a text in the scene language, a function of a seed.
//
// All shapes, aggregates, attributes, lights and textures occur, and what is meant to hurt: coincident objects, faces on
// integer coordinates, planes, glass in glass, motion.  File names are relative to the root of the repository.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace rayshade {

std::string randomScene(std::uint64_t seed);

}  // namespace rayshade
