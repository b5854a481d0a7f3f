// The closed list of textures.  Append only: the position is the tag on the wire.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/type_list.h"
#include "rayshade/textures/checker.h"

namespace rayshade {

using AllTextures = TypeList<Checker>;
using AnyTexture = AllTextures::Variant;

}  // namespace rayshade
