// Every message: its fields, and whether it is a fact or work.
//
// Facts hold in any epoch; work of another epoch than the receiver's is refused.  A packet is
//   version u8 | epoch u32 | message*        message = tag u8 (position in AllMessages), fields
// See docs/wire-format.md.  The tasks and their messages are those of Reinhard & Jansen, figures 2 and 3.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/control.h"
#include "pvm/messages/rays.h"
#include "rayshade/base/type_list.h"

namespace rayshade {

// Append only: the position is the tag.
using AllMessages = TypeList<Forget, Items, ItemsTaken, Configure, Ready, Finish, Report, Ping, Pong, RayTask,
                             ShadowTask, Expect, Answer, PyramidWanted, PrimaryRays, CellWanted, CellItems,
                             Load, Weights, LightAnswers, SampleColors>;

inline constexpr std::uint8_t kWireVersion = 4;

}  // namespace rayshade
