// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <string_view>
#include <vector>

#include "rayshade/scene/parser.h"
#include "rayshade/scene/viewing.h"
#include "tests/fuzz/any_input.h"

namespace rayshade {
namespace {

void demand(bool good) {
  if (!good) std::abort();
}

struct CheckingSink final : SceneSink {
  std::size_t surfaces = 0, objects = 0;
  std::vector<bool> frames = {true};     // known
  std::vector<bool> mentioned = {true};  // frames that something stands in

  void mention(FrameId frame) {
    if (mentioned.size() <= number(frame)) mentioned.resize(number(frame) + 1);
    mentioned[number(frame)] = true;
  }
  void demandSurface(SurfaceId surface) const { demand(surface == kNoSurface || number(surface) < surfaces); }

  void surface(SurfaceId id, const Surface&) override { demand(number(id) == surfaces++); }
  void frame(FrameId id, Frame frame) override {
    demandSurface(frame.surface);
    mention(frame.parent);
    if (frames.size() <= number(id)) frames.resize(number(id) + 1);
    demand(!frames[number(id)]);
    frames[number(id)] = true;
  }
  void object(SceneObject object) override {
    demand(number(object.id) == objects++);
    demandSurface(object.surface);
    mention(object.frame);
    demand(decode<SceneObject>(encode(object)).has_value());
  }
  void settled() override {
    for (std::size_t i = 0; i < mentioned.size(); ++i)
      demand(!mentioned[i] || (i < frames.size() && frames[i]));
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
