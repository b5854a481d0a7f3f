// The closed list of atmospheric effects.  Append only: the position is the tag on the wire.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/atmosphere/fog.h"
#include "rayshade/atmosphere/fog_deck.h"
#include "rayshade/atmosphere/mist.h"
#include "rayshade/base/type_list.h"

namespace rayshade {

using AllEffects = TypeList<Fog, Mist, FogDeck>;
using AnyEffect = AllEffects::Variant;

// The compiler names what is missing; what an effect must have is said at the head of effect.h.
static_assert((AllEffects::forEach([]<Effect E>() {}), true));

}  // namespace rayshade
