// What the parser makes of a text: all that it told its sink, and what it complained of.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rayshade/language/parser.h"

namespace rayshade {

// Keeps everything, and checks the order that SceneSink promises.
struct RecordingSink final : SceneSink {
  std::map<std::uint32_t, Surface> surfaces;
  std::map<std::uint32_t, SceneNode> nodes;
  std::vector<SceneObject> objects;
  int settledCount = 0;

  void surface(SurfaceId id, const Surface& surface) override {
    EXPECT_TRUE(surfaces.emplace(number(id), surface).second);
  }
  void node(NodeId id, SceneNode node) override {
    EXPECT_NE(id, kRootNode);
    if (node.surface != kNoSurface) {
      EXPECT_TRUE(surfaces.contains(number(node.surface)));
    }
    EXPECT_TRUE(nodes.emplace(number(id), std::move(node)).second);
  }
  void object(SceneObject object) override {
    EXPECT_EQ(number(object.id), objects.size());
    if (object.surface != kNoSurface) {
      EXPECT_TRUE(surfaces.contains(number(object.surface)));
    }
    objects.push_back(std::move(object));
  }
  void endOfStatement() override {
    ++settledCount;
    for (const SceneObject& o : objects)
      if (o.node != kRootNode) {
        EXPECT_TRUE(nodes.contains(number(o.node)));
      }
    for (const auto& [id, node] : nodes)
      if (node.parent != kRootNode) {
        EXPECT_TRUE(nodes.contains(number(node.parent)));
      }
  }

  double red(SurfaceId id) const { return id == kNoSurface ? -1 : surfaces.at(number(id)).diffuse.r; }
  const SceneNode& nodeOf(std::size_t object) const { return nodes.at(number(objects.at(object).node)); }
};

struct ParsedText {
  RecordingSink items;
  SceneHead head;
  std::vector<std::string> warnings, printed;
  std::string errors;

  ParseOptions options() {
    ParseOptions options;
    options.warn = [this](const std::string& message) { warnings.push_back(message); };
    options.print = [this](const std::string& message) { printed.push_back(message); };
    return options;
  }
};

inline std::unique_ptr<ParsedText> parse(const std::string& text) {
  auto scene = std::make_unique<ParsedText>();
  try {
    scene->head = parseSceneText(text, "s.ray", scene->options(), scene->items);
  } catch (const SceneError& error) {
    scene->errors = error.what();
  }
  return scene;
}

inline std::unique_ptr<ParsedText> parseFile(const std::string& name, const std::string& arguments = "") {
  auto scene = std::make_unique<ParsedText>();
  ParseOptions options = scene->options();
  options.fileName = name;
  options.preprocessorArguments = arguments;
  try {
    scene->head = parseScene(options, scene->items);
  } catch (const SceneError& error) {
    scene->errors = error.what();
  }
  return scene;
}

inline std::unique_ptr<ParsedText> good(const std::string& text) {
  auto scene = parse(text);
  EXPECT_EQ(scene->errors, "") << text;
  return scene;
}

inline std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

// The lines that messages name.
inline std::vector<int> linesOf(const std::string& messages) {
  std::vector<int> lines;
  for (std::size_t at = 0; (at = messages.find("s.ray:", at)) != std::string::npos; ++at)
    lines.push_back(std::stoi(messages.substr(at + 6)));
  return lines;
}

inline std::string errorOf(const std::string& text) { return firstLine(parse(text)->errors); }

// red 1, green 2, blue 3: told apart by the red channel of their diffuse colour.
inline const std::string kSurfaces =
    "surface red diffuse 1 0 0 surface green diffuse 2 0 0 surface blue diffuse 3 0 0\n";

// The numbers of the surfaces of all objects, by kSurfaces; -1: none.
inline std::vector<double> surfacesOf(const std::string& text) {
  const auto scene = good(kSurfaces + text);
  std::vector<double> reds;
  for (const SceneObject& o : scene->items.objects) reds.push_back(scene->items.red(o.surface));
  return reds;
}
using Reds = std::vector<double>;

}  // namespace rayshade
