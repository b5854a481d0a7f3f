// Any text at all as a scene: it is read or refused, and what is read keeps the order that SceneSink promises.
//
//   clang++ -std=c++20 -fsanitize=fuzzer,address,undefined ... && scene_fuzz tests/fuzz/corpus/scene
// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "rayshade/scene/parser.h"
#include "rayshade/scene/viewing.h"

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
}  // namespace rayshade

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rayshade;
  ParseOptions options;
  std::size_t said = 0;
  options.warn = options.print = [&said](const std::string& text) { said += text.size(); };
  options.flipTriangleNormals = size % 2 == 1;
  CheckingSink sink;
  try {
    const SceneHead head =
        parseSceneText({reinterpret_cast<const char*>(data), size}, "fuzz.ray", options, sink);
    checkHead(head, "fuzz.ray");
  } catch (const SceneError& error) {
    demand(!std::string_view(error.what()).empty());
  }
  return 0;
}
