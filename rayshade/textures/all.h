// The closed list of textures.  Append only: the position is the tag on the wire.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/type_list.h"
#include "rayshade/textures/blotch.h"
#include "rayshade/textures/bump.h"
#include "rayshade/textures/checker.h"
#include "rayshade/textures/cloud.h"
#include "rayshade/textures/fbm.h"
#include "rayshade/textures/fbm_bump.h"
#include "rayshade/textures/gloss.h"
#include "rayshade/textures/image.h"
#include "rayshade/textures/marble.h"
#include "rayshade/textures/mount.h"
#include "rayshade/textures/sky.h"
#include "rayshade/textures/stripe.h"
#include "rayshade/textures/windy.h"
#include "rayshade/textures/wood.h"

namespace rayshade {

using AllTextures = TypeList<Checker, Blotch, Bump, Cloud, Fbm, FbmBump, Gloss, ImageTexture, Marble, Mount,
                             Sky, Stripe, Windy, Wood>;
using AnyTexture = AllTextures::Variant;

// The compiler names what is missing; what a texture must have is said at the head of texture.h.
static_assert((AllTextures::forEach([]<Texture T>() {}), true));

}  // namespace rayshade
