// No absolute epsilon: every small constant in the renderer is known here, with its reason.
//
// A length or a distance that is compared with a constant like 1e-5 makes small scenes wrong (docs/decisions/0007).  What
// stands below compares pure numbers: cosines, colours, shares, or goes together with the size of what it is compared with.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace {

struct Known {
  const char *file, *literal, *reason;
};
constexpr Known kKnown[] = {
    {"rayshade/base/bounds.h", "1e-9", "padding, multiplied with the coordinates"},
    {"rayshade/base/noise.cc", "1e-5", "weight of an octave, rayshade's own"},
    {"rayshade/base/transform.cc", "1e-14", "determinant, multiplied with the volume"},
    {"rayshade/space/cost.cc", "1e-3", "share of rays in an estimate"},
    {"rayshade/events/event_export.cc", "1e-3", "microseconds of a trace"},
    {"rayshade/events/event_export.cc", "1e-9", "seconds of a trace"},
    {"rayshade/image/flip.cc", "0.0047", "a filter of the error measure"},
    {"rayshade/image/flip.cc", "0.0053", "a filter of the error measure"},
    {"rayshade/image/flip.cc", "1e-5", "a filter of the error measure"},
    {"rayshade/sampling/cross_sweep.cc", "1e-5", "sum of two colours"},
    {"rayshade/program/main.cc", "1e-3", "kilobytes in a report"},
    {"rayshade/program/main.cc", "1e-6", "bytes in a report"},
    {"rayshade/program/main.cc", "1e-9", "seconds in a report"},
    {"rayshade/optics/refraction.h", "1e-5", "exponent of a highlight"},
    {"rayshade/optics/surface.h", "1e-5", "share of light"},
    {"rayshade/program/progress.h", "1e-6", "rays in a report"},
    {"rayshade/base/memory.h", "1e-6", "bytes in a message"},
    {"rayshade/scene/camera.cc", "1e-5", "sine of the angle between the line of sight and up"},
    {"rayshade/scene/settings.h", "0.002", "cutoff, a colour"},
    {"rayshade/language/viewing.cc", "1e-5", "sine of the angle between the line of sight and up"},
    {"rayshade/shapes/polygon.cc", "1e-10", "bend that is said, multiplied with the size"},
    {"rayshade/shapes/polygon.cc", "1e-4", "bend, multiplied with the size"},
    {"rayshade/shapes/sphere.h", "1e-5", "v near a pole, a share of a turn"},
    {"rayshade/space/clip_list.cc", "1e-12", "multiplied with the coordinates"},
    {"rayshade/textures/image.cc", "0.001", "coverage, a share"},
    {"rayshade/textures/mapping.cc", "1e-5", "v near a pole, a share of a turn"},
};

TEST(NoEpsilon, EverySmallConstantOfTheRendererIsKnownWithItsReason) {
  const std::regex quiet(R"(//[^\n]*|"[^"\n]*")");
  const std::regex small(R"((^|[^A-Za-z0-9_.])((\d+\.?\d*|\.\d+)e-(\d+)|0?\.00\d+)\b)");
  std::set<std::pair<std::string, std::string>> known, met;
  for (const Known& k : kKnown) known.emplace(k.file, k.literal);
  for (const auto& entry : std::filesystem::recursive_directory_iterator("rayshade")) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().generic_string();
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      const std::string code = std::regex_replace(line, quiet, "");
      for (std::sregex_iterator at(code.begin(), code.end(), small), end; at != end; ++at) {
        const int exponent = (*at)[4].matched ? std::stoi((*at)[4]) : 3;
        if (exponent < 3 || exponent > 15) continue;
        met.emplace(name, (*at)[2]);
        EXPECT_TRUE(known.contains({name, (*at)[2]})) << name << ": " << line;
      }
    }
  }
  EXPECT_EQ(met, known);  // and the list is not longer than it has to be
}

}  // namespace
