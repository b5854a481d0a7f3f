// Where the work of a picture will be, guessed before a ray is traced and without the model.
//
// The sample of the scene is spread over a grid as haze: boxes with shadows A(d) in direction d, in a cell of volume V, take
// rays out at A(d) / V per unit of length; A(d) is the sum over the axes of |d| times the area of the side.  A few primary
// rays are sent through the haze; where they are stopped are the hits, from which rays go to each light.  The work of a
// cell is what passes through it and what is stopped in it.
// What is not seen: reflection and transparency, unbounded objects, and how difficult an object is.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/scene/camera.h"
#include "rayshade/space/bintree.h"
#include "rayshade/space/bounds_sample.h"

namespace rayshade {

// The work in each cell of a grid over `world`, cells without work left out; nothing when `world` is no box that can be
// cut.  Units: one ray that is stopped.
std::vector<CostBox> predictCost(const Bounds& world, const BoundsSample& sample, const View& view,
                                 const PictureSpec& picture, const SceneSettings& settings);

}  // namespace rayshade
