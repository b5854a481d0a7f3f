// The scenes that we show and those made to hurt: each is read without a warning and gives a picture.
//
// The pictures are small: whether a scene is beautiful a test cannot say, only that something is in it.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tests/support/render_text.h"

namespace rayshade {
namespace {

// The names of all scenes in a folder of the repository, sorted.
std::vector<std::string> scenesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".ray") names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

// Reads and renders all scenes of a folder; they name their pictures and maps relative to it.
void expectPictures(const std::string& folder, std::size_t atLeast) {
  const CurrentDirectory inFolder(folder);
  const std::vector<std::string> names = scenesIn(".");
  EXPECT_GE(names.size(), atLeast);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    Job job = jobOf("-q -R 32 20 -S 1 -N 1 " + name);
    std::string warnings;
    job.options.parse.warn = [&](const std::string& text) { warnings += text + "\n"; };
    const Rendered rendered = renderSequentially(job);
    EXPECT_EQ(warnings, "");
    ASSERT_EQ(rendered.frames.size(), 1u);
    const std::vector<float>& values = rendered.frames[0].pixels;
    ASSERT_EQ(values.size(), 3u * 32 * 20);
    EXPECT_TRUE(
        std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v) && v >= 0; }));
    // Something is to be seen: the pixels do not all have one colour.
    EXPECT_FALSE(std::equal(values.begin() + 3, values.end(), values.begin()));
  }
}

TEST(Gallery, EverySceneIsReadWithoutWarningsAndGivesAPicture) { expectPictures("scenes/gallery", 14); }

TEST(Hurt, EverySceneIsReadWithoutWarningsAndGivesAPicture) { expectPictures("scenes/hurt", 5); }

}  // namespace
}  // namespace rayshade
