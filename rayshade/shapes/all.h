// The closed list of shapes.  Append only: the position is the tag on the wire.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/type_list.h"
#include "rayshade/shapes/sphere.h"

namespace rayshade {

using AllShapes = TypeList<Sphere>;
using AnyShape = AllShapes::Variant;

}  // namespace rayshade
