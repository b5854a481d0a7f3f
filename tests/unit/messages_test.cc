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
    PacketMemory read, written;
    while (reader.left() > 0) {
      std::uint8_t tag = 0;
      reader(tag);
      std::size_t position = 0;
      AllMessages::forEach([&]<class M>() {
        if (position++ != tag) return;
        seen.insert(tag);
        M message{};
        serializeInPacket(reader, message, read);
        Writer writer(again);
        writer(tag);
        serializeInPacket(writer, message, written);
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

struct Receiver {
  using Accepted = TypeList<RayTask, Answer>;
  Epoch epoch() const { return Epoch{1}; }
  void on(TaskId, RayTask message) { rays.push_back(std::move(message)); }
  void on(TaskId, Answer message) { answers.push_back(message); }
  std::vector<RayTask> rays;
  std::vector<Answer> answers;
};

struct KeepingLink : NullLink {
  void send(TaskId, std::span<const std::byte> packet) override {
    receivePacket(receiver, TaskId{1}, packet, traffic);
  }
  Receiver receiver;
  Traffic traffic;
};

TEST(Messages, RaysAndColoursSayHowTheyDifferFromTheOneBefore) {
  KeepingLink link;
  Outbox outbox(link);
  outbox.beginEpoch(Epoch{1});
  SeededRandom random(1);
  std::vector<RayTask> rays;
  std::vector<Answer> answers;
  RayTask ray;
  Answer answer;
  for (int i = 0; i < 5000; ++i) {
    ++ray.to.record;
    ++answer.record;
    if (random.oneIn(3)) ray.to.record += std::uint64_t(random.integer(-70000, 70000));
    if (random.oneIn(3)) answer.record -= std::uint64_t(random.integer(-40000, 40000));
    if (random.oneIn(9))
      answer.record = ray.to.record = ~std::uint64_t(random.integer(0, 3)) << random.integer(0, 60);
    if (random.oneIn(4)) ray.to.task = TaskId{random.integer(1, 3)};
    if (random.oneIn(4)) ray.to.slot = answer.slot = kReflectedSlot - Slot(random.integer(0, 1));
    if (random.oneIn(4)) ray.ray.contribution.g = random.real(0, 1);
    if (random.oneIn(6)) ray.ray.moment = {random.real(0, 1), random.integer(0, 2)};
    if (random.oneIn(6)) ray.ray.depth = random.integer(0, 4), ray.ray.sample = random.integer(0, 70);
    if (random.oneIn(6)) ray.ray.extinct = random.real(0, 1);
    ray.ray.media = {};
    if (random.oneIn(5)) ray.ray.media.push_back({1.5, 0.9});
    ray.step = std::uint32_t(random.integer(0, 600));
    ray.ray.origin = random.point(-1, 1);
    answer.color =
        std::array{kBlack, kWhite, answer.color, Color{-0.0, 1, random.real(0, 1)}}[random.below(4)];
    outbox.post(TaskId{2}, ray);
    outbox.post(TaskId{2}, answer);
    rays.push_back(ray);
    answers.push_back(answer);
  }
  outbox.flush();
  EXPECT_EQ(link.traffic.refused, 0u);
  ASSERT_EQ(link.receiver.rays.size(), rays.size());
  ASSERT_EQ(link.receiver.answers.size(), answers.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(encode(link.receiver.rays[i]), encode(rays[i])) << i;
    ASSERT_EQ(encode(link.receiver.answers[i]), encode(answers[i])) << i;
  }
}

TEST(Messages, ARayBehindOneOfItsKindTakes59Bytes) {
  NullLink link;
  Outbox outbox(link);
  outbox.beginEpoch(Epoch{1});
  RayTask ray;
  ray.ray.contribution = {.3, .3, .3};
  const auto post = [&](int rays) {
    ray.to.record = 1;
    for (int i = 0; i < rays; ++i, ++ray.to.record) outbox.post(TaskId{2}, ray);
    outbox.flush();
    return outbox.traffic.bytesOut;
  };
  const std::uint64_t one = post(1);
  EXPECT_EQ(post(101), 2 * one + 100 * 59);
}

TEST(Messages, AColourThatNobodyWaitsForIsRefused) {
  NullLink link;
  TaskContext context(link);
  const EpochSettings at;
  TilesInHand tiles;
  Replies replies(context, at, tiles);
  for (const Slot slot : {Slot{0}, Slot{3}, kReflectedSlot, kTransmittedSlot})
    replies.answer({link.self(), 12345, slot}, kWhite);
  EXPECT_EQ(context.outbox.traffic.refused, 4u);
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
