// The statements that say how the picture is taken: camera, screen, samples, lights, air, report.
//
// The command line may change what they say, so that whether it makes sense is asked at the end: checkHead.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rayshade/language/argument_reader.h"
#include "rayshade/scene/settings.h"

namespace rayshade {

// Reads the arguments of `word`, which has been taken; false when it is no such statement.
bool readViewing(Word word, ArgumentReader& in, SceneHead& head);

// Throws SceneError, naming the file, when no picture can be taken: the view parallel to up, the window not
// on the screen, a sample count outside of 1..8, ...  Ask when the options of the command line have been
// applied.
void checkHead(const SceneHead& head, const std::string& fileName);

}  // namespace rayshade
