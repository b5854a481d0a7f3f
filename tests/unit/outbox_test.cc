// Messages gathered into packets: nothing lost, nothing out of order, nothing in the wrong epoch.
// guarded: juggles packets
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/messages/outbox.h"

#include <gtest/gtest.h>

#include "tests/support/null_link.h"

#include <map>

namespace rayshade {
namespace {

class RecordingLink final : public NullLink {
 public:
  struct Packet {
    TaskId to;
    Bytes bytes;
  };

  void send(TaskId to, std::span<const std::byte> packet) override {
    sent.push_back({to, Bytes(packet.begin(), packet.end())});
  }

  std::vector<Packet> sent;
};

constexpr TaskId kOne{11}, kOther{12};

Answer answer(RecordId record) { return {record, 0, {0.25, 0.5, 1}}; }

struct Content {
  Epoch epoch{};
  std::vector<RecordId> records;
};
// A packet that holds nothing but answers, and facts that stand for one.
Content read(const Bytes& packet) {
  Reader reader(packet);
  std::uint8_t version = 0;
  Content content;
  PacketMemory before;
  reader(version, content.epoch);
  EXPECT_EQ(version, kWireVersion);
  while (reader.left() > 0) {
    std::uint8_t tag = 0;
    reader(tag);
    if (tag == Load::tag) {
      Load fact;
      reader(fact);
      content.records.push_back(static_cast<RecordId>(fact.busy));
      continue;
    }
    EXPECT_EQ(tag, Answer::tag);
    Answer message;
    serializeInPacket(reader, message, before);
    content.records.push_back(message.record);
  }
  EXPECT_TRUE(reader.ok());
  return content;
}

TEST(Outbox, NothingGoesBeforeItIsFlushed) {
  RecordingLink link;
  Outbox outbox(link);
  outbox.post(kOne, answer(1));
  EXPECT_TRUE(link.sent.empty());
  outbox.flush();
  ASSERT_EQ(link.sent.size(), 1u);
  EXPECT_EQ(link.sent[0].to, kOne);
  outbox.flush();
  EXPECT_EQ(link.sent.size(), 1u) << "there was nothing more to send";
}

TEST(Outbox, EachDestinationGetsItsOwnInOrder) {
  RecordingLink link;
  Outbox outbox(link);
  for (RecordId i = 0; i < 100; ++i) outbox.post(i % 3 == 0 ? kOne : kOther, answer(i));
  outbox.flush();
  ASSERT_EQ(link.sent.size(), 2u);
  for (const auto& packet : link.sent) {
    std::vector<RecordId> expected;
    for (RecordId i = 0; i < 100; ++i)
      if ((i % 3 == 0 ? kOne : kOther) == packet.to) expected.push_back(i);
    EXPECT_EQ(read(packet.bytes).records, expected);
  }
}

TEST(Outbox, AFullPacketGoesByItself) {
  RecordingLink link;
  Outbox outbox(link);
  RecordId posted = 0;
  while (link.sent.size() < 3) outbox.post(kOne, answer(posted++));
  std::vector<RecordId> all;
  for (const auto& packet : link.sent) {
    EXPECT_GE(packet.bytes.size(), Outbox::kFull);
    EXPECT_LT(packet.bytes.size(), Outbox::kFull + 64);
    for (RecordId record : read(packet.bytes).records) all.push_back(record);
  }
  ASSERT_EQ(all.size(), posted);
  for (RecordId i = 0; i < posted; ++i) ASSERT_EQ(all[i], i);
}

TEST(Outbox, WhatWasOpenGoesWithTheEpochItBelongsTo) {
  RecordingLink link;
  Outbox outbox(link);
  outbox.post(kOne, answer(1));
  outbox.beginEpoch(Epoch{7});
  outbox.post(kOne, answer(2));
  outbox.post(kOther, answer(3));
  outbox.beginEpoch(Epoch{8});
  outbox.post(kOne, answer(4));
  outbox.flush();
  std::map<RecordId, Epoch> epochs;
  for (const auto& packet : link.sent) {
    const Content content = read(packet.bytes);
    for (RecordId record : content.records) epochs[record] = content.epoch;
  }
  EXPECT_EQ(epochs, (std::map<RecordId, Epoch>{{1, Epoch{0}}, {2, Epoch{7}}, {3, Epoch{7}}, {4, Epoch{8}}}));
}

TEST(Outbox, WhatGoesToAllIsTheSameForEach) {
  RecordingLink link;
  Outbox outbox(link);
  outbox.post(kOther, answer(1));
  const TaskId all[] = {kOne, kOther};
  outbox.postToAll(all, Load{2});
  outbox.post(kOne, answer(3));
  outbox.flush();
  std::map<TaskId, std::vector<RecordId>> records;
  for (const auto& packet : link.sent) records[packet.to] = read(packet.bytes).records;
  EXPECT_EQ(records, (std::map<TaskId, std::vector<RecordId>>{{kOne, {2, 3}}, {kOther, {1, 2}}}));
  EXPECT_EQ(outbox.traffic.messagesOut, 4u);
}

TEST(Outbox, CountsWhatItSends) {
  RecordingLink link;
  Outbox outbox(link);
  for (RecordId i = 0; i < 5; ++i) outbox.post(kOne, answer(i));
  outbox.post(kOther, Finish{});
  outbox.flush();
  EXPECT_EQ(outbox.traffic.messagesOut, 6u);
  EXPECT_EQ(outbox.traffic.packetsOut, 2u);
  EXPECT_EQ(outbox.traffic.bytesOut, link.sent[0].bytes.size() + link.sent[1].bytes.size());
}

}  // namespace
}  // namespace rayshade
