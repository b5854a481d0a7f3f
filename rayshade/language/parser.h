// The input language of Rayshade 4: text in, items out.
//
// parseScene() hands the items to a sink one by one and keeps names, surfaces and variables only, so a scene
// of any size is read in bounded memory.  The numbers of the items follow the order of the file: parsing the
// same text twice gives the same numbers.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "rayshade/base/error.h"
#include "rayshade/image/image_library.h"
#include "rayshade/scene/items.h"
#include "rayshade/scene/settings.h"

namespace rayshade {

struct ParseOptions {
  std::string fileName;               // empty or "-": standard input
  bool preprocess = true;             // -u turns it off; done only when the text has directives
  std::string preprocessorArguments;  // -P
  bool flipTriangleNormals = false;   // -f: triangles and polygons
  std::function<void(const std::string&)>
      warn;  // gets complete lines `file:line:column: warning: ...`; may be empty
  std::function<void(const std::string&)> print;  // gets what `print` statements print; may be empty
  // Pictures that have been read; textures and tasks find the pixels as long as it lives.
  std::shared_ptr<ImageLibrary> images = std::make_shared<ImageLibrary>();
};

// Aggregates, names and instances of names may be this deep inside of each other, all levels added up.
inline constexpr int kDeepestNesting = 1000;

// Reads a scene.  Throws SceneError, with every message (at most 20), when it is wrong; the sink hears of
// nothing behind the first.  Whether the head makes sense, checkHead() tells (scene/viewing.h).
SceneHead parseScene(const ParseOptions& options, SceneSink& sink);

// The same from memory; `name` stands for the file in messages.  No preprocessing.
SceneHead parseSceneText(std::string_view text, const std::string& name, const ParseOptions& options,
                         SceneSink& sink);

}  // namespace rayshade
