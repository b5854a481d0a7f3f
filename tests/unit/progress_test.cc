// What is said while a picture is rendered, and how well the rest is foreseen.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/progress.h"

#include <gtest/gtest.h>

#include <string>

#include "rayshade/base/random.h"
#include "tests/support/program.h"
#include "tests/support/traced_tile.h"

namespace rayshade {
namespace {

std::string saidOfAThousandSamples(bool terminal, double secondsEach) {
  double clock = 0;
  testing::internal::CaptureStderr();
  {
    ProgressLine line(true, terminal, [&clock] { return clock; });
    for (std::uint64_t samples = 1; samples <= 1000; ++samples) {
      clock += secondsEach;
      line.show({static_cast<std::int32_t>(samples / 10), 100, samples, 1000});
    }
  }
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, IsALineForEachTenthWhereThereIsNoTerminal) {
  const std::string slow = saidOfAThousandSamples(false, 0.1);
  EXPECT_EQ(countLines(slow), 10u) << slow;
  EXPECT_TRUE(slow.starts_with(" 10 %  row 10 of 100  0.00 M samples/s  90 s left\n")) << slow;
  EXPECT_EQ(saidOfAThousandSamples(false, 0.0005), "");  // over before one could read it
  EXPECT_EQ(countLines(saidOfAThousandSamples(false, 0.0045)), 4u);
}

TEST(Progress, IsOneLineThatGoesAwayOnATerminal) {
  const std::string said = saidOfAThousandSamples(true, 0.1);
  EXPECT_EQ(countLines(said), 0u);
  EXPECT_TRUE(said.starts_with("\r")) << said;
  EXPECT_TRUE(said.ends_with("\r\033[K")) << said;
}

// A picture in which a third of the columns is noise, which gets many samples, and the rest is of one colour.
TEST(Progress, ForeseesTheSamplesOfARefinedPicture) {
  for (const std::int32_t side : {1, 2, 4}) {
    PictureSpec spec;
    spec.width = 90;
    spec.height = 80;
    spec.samplesPerSide = side;
    Sampler sampler(spec, 1, 0, 8);
    std::vector<Completed> steps;
    std::vector<Color> row;
    std::uint32_t count = 0;
    while (!sampler.finished()) {
      while (supplyNext(sampler, [&](const SampleId& id) {
        const double noise = id.x % 3 == 0 && id.x < 30 ? static_cast<double>(mixBits(++count) % 2) : 0.5;
        return Color{noise, noise, noise};
      }))
        steps.push_back(sampler.completed());
      while (sampler.takeRow(row)) {
      }
    }
    const double all = static_cast<double>(steps.back().samples);
    EXPECT_EQ(sampler.completed().rows, 80);
    for (std::size_t i = steps.size() / 4; i < steps.size(); ++i)
      ASSERT_NEAR(static_cast<double>(steps[i].expected), all, 0.25 * all) << side << " at " << i;
    if (side == 1) {
      EXPECT_EQ(steps[0].expected, 90u * 80u);
    }
  }
}

}  // namespace
}  // namespace rayshade
