// Every message as it really travels: taken from the traffic of simulated renders.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/all.h"

#include <gtest/gtest.h>

#include <set>

#include "pvm/shade/shade_task.h"
#include "pvm/trace/pyramid_task.h"
#include "pvm/trace/voxel_task.h"
#include "tests/support/null_link.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

constexpr std::size_t kHead = sizeof kWireVersion + sizeof(Epoch);

std::vector<Bytes> traffic() {
  std::vector<Bytes> packets;
  for (std::uint64_t seed : {0u, 3u, 7u, 12u}) {
    HostOptions host;
    host.wishes.voxels = 3;
    host.wishes.shades = 2;
    host.wishes.pyramids = static_cast<std::uint32_t>(seed % 4) / 2 + 1;
    host.cells = 20;
    host.tilePixels = 16;
    host.window = 20;
    host.policy.shadows = ShadowPolicy{static_cast<std::uint8_t>(seed % 3)};
    host.policy.secondariesTravel = seed % 2 == 0;
    if (seed % 2 == 0) host.policy.horizon = {Horizon::Kind::cells, 3};
    SimulatedMachine::Options machine;
    machine.seed = seed;
    renderByTasks(jobOfText(randomScene(seed)), host, machine, [&](SimulatedMachine& m) {
      m.beforeDelivery = [&](TaskId, TaskId, std::span<const std::byte> packet) {
        if (!packet.empty()) packets.emplace_back(packet.begin(), packet.end());
      };
    });
  }
  return packets;
}

const std::vector<Bytes>& knownTraffic() {
  static const std::vector<Bytes> packets = traffic();
  return packets;
}

TEST(Messages, DecodedAndEncodedAgainTheyHaveTheSameBytes) {
  std::set<std::size_t> seen;
  for (const Bytes& packet : knownTraffic()) {
    Reader reader(packet);
    std::uint8_t version = 0;
    Epoch epoch{};
    reader(version, epoch);
    ASSERT_EQ(version, kWireVersion);
    Bytes again;
    Writer{again}(version, epoch);
    while (reader.left() > 0) {
      std::uint8_t tag = 0;
      reader(tag);
      std::size_t position = 0;
      AllMessages::forEach([&]<class M>() {
        if (position++ != tag) return;
        seen.insert(tag);
        M message{};
        reader(message);
        Writer{again}(tag, message);
      });
      ASSERT_TRUE(reader.ok()) << "message " << static_cast<int>(tag);
    }
    ASSERT_TRUE(again == packet);
  }
  for (std::size_t tag :
       {PositionIn<Forget, AllMessages>::value, PositionIn<Items, AllMessages>::value,
        PositionIn<Configure, AllMessages>::value, PositionIn<Ready, AllMessages>::value,
        PositionIn<Report, AllMessages>::value, PositionIn<RayTask, AllMessages>::value,
        PositionIn<ShadowTask, AllMessages>::value, PositionIn<Expect, AllMessages>::value,
        PositionIn<Answer, AllMessages>::value, PositionIn<PyramidWanted, AllMessages>::value,
        PositionIn<PrimaryRays, AllMessages>::value, PositionIn<CellWanted, AllMessages>::value,
        PositionIn<CellItems, AllMessages>::value})
    EXPECT_TRUE(seen.contains(tag)) << "message " << tag << " never travelled";
}

TEST(Messages, EmptyOnesSurviveTheWireToo) {
  AllMessages::forEach([]<class M>() {
    const Bytes bytes = encode(M{});
    Reader reader(bytes);
    M back{};
    reader(back);
    if (reader.ok()) {  // an empty tree or camera is no good one, and may be refused
      EXPECT_TRUE(encode(back) == bytes) << typeid(M).name();
    }
  });
}

TEST(Messages, CutShortTheyAreRefused) {
  AllMessages::forEach([]<class M>() {
    const Bytes bytes = encode(M{});
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_FALSE(decode<M>(std::span(bytes).first(size)).has_value())
          << typeid(M).name() << " of " << size << " bytes";
  });
}

// What a task does with packets that nobody sent.
template <class Task>
void feed(const std::vector<Bytes>& packets) {
  NullLink link;
  Task task(link);
  for (const Bytes& packet : packets) {
    task.receive({LinkEvent::Kind::packet, TaskId{1}, "", packet});
    task.work(0);
    task.flush();
  }
}

TEST(Messages, DamagedPacketsDoNoHarm) {
  const std::vector<Bytes>& packets = knownTraffic();
  SeededRandom random(1);
  std::vector<Bytes> damaged;
  for (int i = 0; i < 1500; ++i) {
    Bytes packet = random.pick(packets);
    const int flips = random.integer(0, 3);
    for (int flip = 0; flip < flips; ++flip)
      packet[random.below(packet.size())] ^= std::byte(1u << random.below(8));
    if (random.oneIn(4)) packet.resize(random.below(packet.size() + 1));
    damaged.push_back(std::move(packet));
  }
  feed<VoxelTask>(damaged);
  feed<PyramidTask>(damaged);
  feed<ShadeTask>(damaged);
}

// Only a task itself knows its locally shaded hits (local_hits.h): nobody may claim to bring a colour to one.
TEST(Messages, ARayWithTheAddressOfItsReceiverIsRefused) {
  NullLink link;
  VoxelTask task(link);
  RayTask ray;
  ray.to = {link.self(), 12345, kReflectedSlot};
  task.on(TaskId{1}, RayTask(ray));
  EXPECT_EQ(task.waiting(), 0u);
  ray.to.task = TaskId{7};
  task.on(TaskId{1}, RayTask(ray));
  EXPECT_EQ(task.waiting(), 1u);
}

TEST(Messages, WorkBeforeTheFirstConfigureIsNotDone) {
  for (const Bytes& original : knownTraffic()) {
    if (original.size() <= kHead) continue;
    const auto first = static_cast<std::size_t>(original[kHead]);
    if (first == PositionIn<Configure, AllMessages>::value || first == PositionIn<Forget, AllMessages>::value)
      continue;
    Bytes packet = encode(Epoch{});
    packet.insert(packet.begin(), std::byte{kWireVersion});
    packet.insert(packet.end(), original.begin() + kHead, original.end());
    feed<VoxelTask>({packet});
    feed<PyramidTask>({packet});
    feed<ShadeTask>({packet});
  }
}

}  // namespace
}  // namespace rayshade
