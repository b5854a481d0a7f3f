// With --shading separate the data driven schedule sends what figures 2 and 3 of Reinhard & Jansen show: for each ray and each
// intersection, between the same roles and in the same order.
// guarded: juggles tasks
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "tests/support/compare_pictures.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

const std::string kScene =
    "screen 40 30 sample 1 nojitter eyep 0 -9 1 maxdepth 4 light 1 point 3 -9 9 light .4 directional -1 -1 1 "
    "surface mirror diffuse .2 .2 .2 specular 1 1 1 reflect .7 "
    "surface glass diffuse 0 0 0 specular 1 1 1 reflect .3 transp .8 body 1 1 1 index 1.3 "
    "box mirror -6 -6 -1.5 6 6 -1 sphere mirror 1 -2 0 0 sphere glass 1 0 -1 0 sphere mirror 1 2 0 0 "
    "sphere glass .6 1 -2 .5 sphere mirror .5 -1 -2 0 box mirror -1 2 -1  1 3 2 ";

// All work of a run, by the roles of who sends and who receives, in the order of its delivery.
class Diagram {
 public:
  void watch(SimulatedMachine& machine) {
    machine.beforeDelivery = [this](TaskId from, TaskId to, std::span<const std::byte> packet) {
      if (packet.empty()) return;
      Reader reader(packet);
      std::uint8_t version = 0, tag = 0;
      Epoch epoch{};
      PacketMemory before;
      reader(version, epoch);
      while (reader.left() > 0) {
        reader(tag);
        AllMessages::forEach([&]<class M>() {
          if (M::tag != tag) return;
          M message{};
          serializeInPacket(reader, message, before);
          if constexpr (!M::isFact) {
            ++sent_[{from, to, M::tag}];
            note(to, message);
          }
        });
      }
    };
  }
  void learnRoles(const HostSummary& summary) {
    for (const TaskSummary& task : summary.tasks) roles_[task.task] = task.placement.role;
    roles_[TaskId{1}] = Role::host;
  }

  // Messages of a kind from tasks of one role to those of another; they are not left then.
  template <class M>
  std::uint64_t take(Role from, Role to) {
    std::uint64_t messages = 0;
    std::erase_if(sent_, [&](const auto& entry) {
      const auto& [sender, receiver, tag] = entry.first;
      const bool meant = tag == M::tag && roles_.at(sender) == from && roles_.at(receiver) == to;
      messages += meant ? entry.second : 0;
      return meant;
    });
    return messages;
  }
  std::size_t left() const { return sent_.size(); }

  std::uint64_t samples = 0, coloursOfSamples = 0, lightsAwaited = 0, lightsCome = 0, onwardAwaited = 0;
  std::uint64_t early = 0;  // intersections whose colour was sent on before all that it waits for had come

 private:
  struct Intersection {
    bool known = false;
    std::int64_t missing = 0;
    ReplyTo to;
  };
  using Place = std::pair<TaskId, RecordId>;

  template <class M>
  void note(TaskId, const M&) {}
  void note(TaskId, const PrimaryRays& message) { samples += message.samples.size(); }
  void note(TaskId, const SampleColors& message) { coloursOfSamples += message.colors.size(); }
  void note(TaskId at, const Expect& message) {
    const int onward = message.hit.back.transmitted + message.hit.back.reflected;
    lightsAwaited += message.pending.size();
    onwardAwaited += static_cast<std::uint64_t>(onward);
    if (message.pending.empty() && onward == 0) return;  // it is complete and has no record of its own
    Intersection& hit = open_[{at, message.record}];
    hit.known = true;
    hit.missing += onward + static_cast<int>(message.pending.size());
    hit.to = message.to;
    answered_[{message.to.task, message.to.record, message.to.slot}] = {at, message.record};
  }
  void note(TaskId at, const LightAnswers& message) {
    lightsCome += message.colors.size();
    open_[{at, message.record}].missing -= static_cast<std::int64_t>(message.colors.size());
  }
  void note(TaskId at, const Answer& message) {
    if (const auto hit = answered_.find({at, message.record, message.slot}); hit != answered_.end())
      early += open_.at(hit->second).missing != 0;
    --open_[{at, message.record}].missing;
  }

  std::map<std::tuple<TaskId, TaskId, std::uint8_t>, std::uint64_t> sent_;
  std::map<TaskId, Role> roles_;
  std::map<Place, Intersection> open_;
  std::map<std::tuple<TaskId, RecordId, Slot>, Place> answered_;
};

TEST(ProcessDiagrams, SeparateShadingSendsWhatFigures2And3Show) {
  const Job job = jobOfText(kScene);
  const Rendered alone = renderSequentially(job);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    HostOptions options;
    options.wishes.voxels = 3;
    options.wishes.shades = 2;
    options.policy.shadeLocally = false;
    options.policy.shadows = ShadowPolicy::forward;
    Diagram diagram;
    const RenderedByTasks got = renderByTasks(job, options, {.seed = seed},
                                              [&](SimulatedMachine& machine) { diagram.watch(machine); });
    EXPECT_EQ(difference(got.frames, alone.frames), "");
    diagram.learnRoles(got.summary);

    // Figure 2: rays out, pixel values in.
    EXPECT_GT(diagram.take<PrimaryRays>(Role::host, Role::voxelTrace), 0u);
    const std::uint64_t pixelValues = diagram.take<Answer>(Role::shade, Role::host);
    diagram.take<SampleColors>(Role::voxelTrace, Role::host);  // of primary rays that meet nothing
    EXPECT_EQ(diagram.samples, alone.counts.primaryRays);
    EXPECT_EQ(diagram.coloursOfSamples + pixelValues, diagram.samples);
    EXPECT_GT(pixelValues, 0u);

    // Figure 3, left: rays that leave a voxel; each intersection to a shade task, with its colours or before them.
    EXPECT_GT(diagram.take<RayTask>(Role::voxelTrace, Role::voxelTrace), 0u);
    EXPECT_GT(diagram.take<ShadowTask>(Role::voxelTrace, Role::voxelTrace), 0u);
    EXPECT_EQ(diagram.take<Expect>(Role::voxelTrace, Role::shade), alone.counts.hits);
    EXPECT_GT(diagram.take<LightAnswers>(Role::voxelTrace, Role::shade), 0u);
    EXPECT_EQ(diagram.lightsCome, diagram.lightsAwaited);

    // Right: colours from tracing and other shade tasks come in, and one goes out for each intersection.
    const std::uint64_t fromTracing = diagram.take<Answer>(Role::voxelTrace, Role::shade),
                        fromShading = diagram.take<Answer>(Role::shade, Role::shade);
    EXPECT_EQ(fromTracing + fromShading, diagram.onwardAwaited);
    EXPECT_EQ(fromShading + pixelValues, alone.counts.hits);
    EXPECT_EQ(diagram.early, 0u);
    EXPECT_EQ(diagram.left(), 0u) << "messages that the figures do not have";
  }
}

}  // namespace
}  // namespace rayshade
