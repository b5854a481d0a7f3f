// The closed list of shapes.  Append only: the position is the tag on the wire.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/type_list.h"
#include "rayshade/shapes/blob.h"
#include "rayshade/shapes/box.h"
#include "rayshade/shapes/cone.h"
#include "rayshade/shapes/cylinder.h"
#include "rayshade/shapes/disc.h"
#include "rayshade/shapes/height_field.h"
#include "rayshade/shapes/plane.h"
#include "rayshade/shapes/polygon.h"
#include "rayshade/shapes/sphere.h"
#include "rayshade/shapes/torus.h"
#include "rayshade/shapes/triangle.h"
#include "rayshade/shapes/triangle_uv.h"

namespace rayshade {

using AllShapes = TypeList<Sphere, Box, Plane, Disc, Cylinder, Cone, Triangle, TriangleUv, Polygon,
                           PhongTriangle, Torus, Blob, HeightField>;
using AnyShape = AllShapes::Variant;

// The compiler names what is missing; what a shape must have is said at the head of shape.h.
static_assert((AllShapes::forEach([]<Shape S>() {}), true));

}  // namespace rayshade
