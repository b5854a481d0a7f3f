// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <string_view>
#include <vector>

#include "rayshade/language/parser.h"
#include "rayshade/language/viewing.h"
#include "tests/fuzz/any_input.h"

namespace rayshade {
namespace {

void demand(bool good) {
  if (!good) std::abort();
}

struct CheckingSink final : SceneSink {
  std::size_t surfaces = 0, objects = 0;
  std::vector<bool> nodes = {true};      // known
  std::vector<bool> mentioned = {true};  // nodes that something stands in

  void mention(NodeId node) {
    if (mentioned.size() <= number(node)) mentioned.resize(number(node) + 1);
    mentioned[number(node)] = true;
  }
  void demandSurface(SurfaceId surface) const { demand(surface == kNoSurface || number(surface) < surfaces); }

  void surface(SurfaceId id, const Surface&) override { demand(number(id) == surfaces++); }
  void node(NodeId id, SceneNode node) override {
    demandSurface(node.surface);
    mention(node.parent);
    if (nodes.size() <= number(id)) nodes.resize(number(id) + 1);
    demand(!nodes[number(id)]);
    nodes[number(id)] = true;
  }
  void object(SceneObject object) override {
    demand(number(object.id) == objects++);
    demandSurface(object.surface);
    mention(object.node);
    demand(decode<SceneObject>(encode(object)).has_value());
  }
  void endOfStatement() override {
    for (std::size_t i = 0; i < mentioned.size(); ++i)
      demand(!mentioned[i] || (i < nodes.size() && nodes[i]));
  }
};

}  // namespace

void takeAnyScene(std::span<const std::byte> input) {
  ParseOptions options;
  std::size_t said = 0;
  options.warn = options.print = [&said](const std::string& text) { said += text.size(); };
  options.flipTriangleNormals = input.size() % 2 == 1;
  CheckingSink sink;
  try {
    const SceneHead head = parseSceneText({reinterpret_cast<const char*>(input.data()), input.size()},
                                          "fuzz.ray", options, sink);
    checkHead(head, "fuzz.ray");
  } catch (const SceneError& error) {
    demand(!std::string_view(error.what()).empty());
  }
}

}  // namespace rayshade
