// Pictures of textures on several machines, in one process: the same bits, whoever reads them, whoever dies.
// guarded: juggles tasks
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/compare_pictures.h"
#include "tests/support/render_text.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

constexpr std::int32_t kSide = 301;  // 272 KB: several pieces

class Images : public testing::Test {
 protected:
  void SetUp() override {
    std::string text = "P6 " + std::to_string(kSide) + " " + std::to_string(kSide) + " 255\n";
    for (std::uint32_t i = 0; i < std::uint32_t{kSide} * kSide * 3; ++i)
      text += static_cast<char>(i * 2654435761u >> 24);
    std::ofstream(scratch_ / "noise.ppm", std::ios::binary) << text;
    const std::string image = " texture image " + scratch_ / "noise.ppm";
    job_ = jobOfText(
        "screen 12 12 eyep 0 -8 3 lookp 0 0 0 fov 40\n"
        "light 1 directional 1 -1 1 light .5 point -3 -5 6\n"
        "surface w diffuse .8 .8 .8 specular .3 .3 .3 reflect .3\n"
        "name both grid 2 1 1 sphere w 1 1 0 0" +
        image +
        " map spherical sphere w 1 -1 0 0 end\n"
        "object both translate 0 1 0 object both scale .7 .7 .7 translate 1 -2 0\n"
        "sphere w 1 -2 -1 1" +
        image +
        " component body smooth\n"
        "box w -4 -4 -1.5 4 4 -1.2" +
        image + " map planar\n");
    job_.options.samples = 1;  // the work takes far fewer bytes than the pixels
    expected_ = renderSequentially(job_).frames;
  }
  RenderedByTasks render(std::uint32_t pyramids, ShadowPolicy shadows,
                         const SimulatedMachine::Options& machine) {
    HostOptions host;
    host.wishes.voxels = 4;
    host.wishes.pyramids = pyramids;
    host.policy.shadows = shadows;
    return renderByTasks(job_, host, machine);
  }

  ScratchDirectory scratch_{"images"};
  Job job_;
  std::vector<Picture> expected_;
};

TEST_F(Images, LieOnceOnEachMachineWithTheSameBitsInAllSchedules) {
  for (const std::uint32_t pyramids : {0u, 3u})
    for (const ShadowPolicy shadows : {ShadowPolicy::forward, ShadowPolicy::local}) {
      SCOPED_TRACE(std::to_string(pyramids) + " pyramids, shadows " +
                   std::to_string(static_cast<int>(shadows)));
      SimulatedMachine::Options machine;
      machine.hosts = {{"a", 1000}, {"b", 1000}, {"c", 1000}};
      const RenderedByTasks got = render(pyramids, shadows, machine);
      EXPECT_EQ(difference(got.frames, expected_), "");
      std::map<std::string, std::uint64_t> bytes;  // into the tasks of each machine
      for (const TaskSummary& task : got.summary.tasks) {
        EXPECT_EQ(task.report.refused, 0u);
        bytes[task.placement.host] += task.report.bytesIn;
      }
      EXPECT_LT(bytes["a"], std::uint64_t{kSide} * kSide * 3) << "the host program's machine";
      EXPECT_LT(bytes["b"], 2 * std::uint64_t{kSide} * kSide * 3);
      EXPECT_LT(bytes["c"], 2 * std::uint64_t{kSide} * kSide * 3);
    }
}

TEST_F(Images, ComeAgainForSuccessors) {
  int deaths = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    SimulatedMachine::Options machine;
    machine.seed = seed;
    machine.hosts = {{"a", 1000}, {"b", 1000}};
    machine.movesPerDeath = 60;
    machine.mostDeaths = 3;
    const RenderedByTasks got = render(seed % 3, ShadowPolicy{static_cast<std::uint8_t>(seed % 3)}, machine);
    deaths += got.deaths;
    EXPECT_EQ(difference(got.frames, expected_), "");
  }
  EXPECT_GT(deaths, 12);
}

}  // namespace
}  // namespace rayshade
