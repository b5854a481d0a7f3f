// The scenes of the manual, split over tasks: the same bits as in one process.  The manual has an example of every
// primitive, texture, light and effect (language_test asks for it), so this is a test of how each of them travels.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/support/compare_pictures.h"
#include "tests/support/manual.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

TEST(Manual, EveryExampleHasTheSameBitsWhenItIsSplitOverTasks) {
  const std::vector<std::string> examples = examplesOf("docs/language.md");
  ASSERT_GE(examples.size(), 30u) << "docs/language.md: run the tests from the top of the repository";
  std::uint64_t seed = 0;
  for (const std::string& example : examples) {
    SCOPED_TRACE("docs/language.md:\n" + example);
    const TemporaryFile file(example);
    Job job;
    job.options.parse.fileName = file.name();
    job.options.resolution = {16, 12};
    job.options.window = {0, 15, 0, 11};
    job.options.samples = 2;
    HostOptions host;
    host.wishes.voxels = 3;
    host.wishes.shades = 1 + seed % 2;
    host.wishes.pyramids = seed % 3 == 0 ? 1 : 0;
    host.voxelsPerTask = 2;
    host.policy.shadows = ShadowPolicy{static_cast<std::uint8_t>(seed % 3)};
    SimulatedMachine::Options machine;
    machine.seed = seed++;
    const RenderedByTasks got = renderByTasks(job, host, machine);
    EXPECT_EQ(difference(got.frames, renderSequentially(job).frames), "");
    for (const TaskSummary& task : got.summary.tasks) EXPECT_EQ(task.report.refused, 0u);
  }
}

}  // namespace
}  // namespace rayshade
