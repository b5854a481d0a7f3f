// The model of a scene that a test has written, with a region of all objects of its world.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "rayshade/intersect/model.h"
#include "rayshade/language/parser.h"

namespace rayshade {

struct TextModel {
  // Throws SceneError.  Warnings go nowhere.
  explicit TextModel(const std::string& scene, const Exposure& exposure = {}) {
    ParseOptions options;
    options.warn = options.print = [](const std::string&) {};
    parseSceneText(scene, "s.ray", options, model.store());
    model.prepare(exposure);
    const auto all = model.store().objectsOf(kWorld);
    region = model.regionOf({all.begin(), all.end()});
  }

  Model model;
  Region region;
};

}  // namespace rayshade
