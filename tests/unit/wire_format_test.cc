// docs/wire-format.md says what the code does: its example is decoded, its list of messages is compared.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "pvm/messages/inbox.h"

namespace rayshade {
namespace {

std::string textOf(const char* file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string document() { return textOf("docs/wire-format.md"); }

// The bytes of the block ```wire, without what stands behind #.
Bytes exampleOfDocument() {
  const std::string text = document(), open = "```wire\n";
  const std::size_t begin = text.find(open);
  if (begin == std::string::npos) return {};
  std::istringstream block(
      text.substr(begin + open.size(), text.find("```", begin + 3) - begin - open.size()));
  Bytes bytes;
  for (std::string line; std::getline(block, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;)
      bytes.push_back(static_cast<std::byte>(std::stoi(word, nullptr, 16)));
  }
  return bytes;
}

struct Receiver {
  using Accepted = TypeList<RayTask, Answer>;
  Epoch epoch() const { return Epoch{2}; }
  void on(TaskId, RayTask message) { rays.push_back(std::move(message)); }
  void on(TaskId, Answer message) { answers.push_back(message); }
  std::vector<RayTask> rays;
  std::vector<Answer> answers;
};

TEST(WireFormat, TheExampleIsWhatTheDocumentSays) {
  const Bytes bytes = exampleOfDocument();
  ASSERT_FALSE(bytes.empty()) << "docs/wire-format.md: run the tests from the top of the repository";
  Receiver receiver;
  Traffic traffic;
  receivePacket(receiver, TaskId{1}, bytes, traffic);
  EXPECT_EQ(traffic.refused, 0u);
  EXPECT_EQ(traffic.stale, 0u);
  ASSERT_EQ(receiver.rays.size(), 1u);
  ASSERT_EQ(receiver.answers.size(), 2u);

  const RayTask& task = receiver.rays[0];
  EXPECT_EQ(task.ray.origin, (Vec3{0, -10, 0}));
  EXPECT_EQ(task.ray.direction, (Vec3{0, 1, 0}));
  EXPECT_EQ(task.ray.key, RandomKey{0x0123456789abcdef});
  EXPECT_EQ(task.ray.moment.time, 0);
  EXPECT_EQ(task.ray.moment.frame, 0);
  EXPECT_EQ(task.ray.depth, 1);
  EXPECT_EQ(task.ray.sample, 0);
  EXPECT_EQ(task.ray.contribution, (Color{0.5, 0.25, 0}));
  EXPECT_EQ(task.ray.extinct, 1);
  EXPECT_TRUE(task.ray.media.empty());
  EXPECT_EQ(task.step, 3u);
  EXPECT_EQ(task.to.task, TaskId{0x40002});
  EXPECT_EQ(task.to.record, 5u);
  EXPECT_EQ(task.to.slot, kTransmittedSlot);
  EXPECT_EQ(receiver.answers[0].record, 7u);
  EXPECT_EQ(receiver.answers[0].slot, 0u);
  EXPECT_EQ(receiver.answers[0].color, kWhite);
  EXPECT_EQ(receiver.answers[1].record, 8u);
  EXPECT_EQ(receiver.answers[1].slot, kReflectedSlot);
  EXPECT_EQ(receiver.answers[1].color, (Color{0.5, 0.25, 0}));
}

TEST(WireFormat, TheExampleIsWhatTheCodeWrites) {
  const Bytes bytes = exampleOfDocument();
  Receiver receiver;
  Traffic traffic;
  receivePacket(receiver, TaskId{1}, bytes, traffic);
  ASSERT_EQ(receiver.rays.size() + receiver.answers.size(), 3u);
  Bytes again;
  Writer{again}(kWireVersion, Epoch{2});
  auto write = [&again]<class M>(const M& message) {
    Writer{again}(static_cast<std::uint8_t>(PositionIn<M, AllMessages>::value), message);
  };
  write(receiver.rays[0]);
  write(receiver.answers[0]);
  write(receiver.answers[1]);
  EXPECT_EQ(again, bytes);
}

// Names as they stand in the code, because a program does not know the names of its types.
std::vector<std::string> namesOfMessages() {
  const std::string source = textOf("pvm/messages/all.h");
  std::smatch list;
  std::vector<std::string> names;
  if (!std::regex_search(source, list, std::regex("using AllMessages =\\s*TypeList<([A-Za-z,\\s]*)>")))
    return names;
  const std::string inside = list[1];
  const std::regex name("[A-Za-z]+");
  for (std::sregex_iterator at(inside.begin(), inside.end(), name), end; at != end; ++at)
    names.push_back(at->str());
  return names;
}

TEST(WireFormat, TheListHasEveryMessageWithItsTagKindAndLeastSize) {
  const std::string text = document();
  const std::regex row("\n- ([0-9]+) `([A-Za-z]+)`, (fact|work), ([0-9]+)(?=[:\n])");
  std::vector<std::smatch> rows;
  for (std::sregex_iterator at(text.begin(), text.end(), row), end; at != end; ++at) rows.push_back(*at);
  const std::vector<std::string> names = namesOfMessages();
  ASSERT_EQ(names.size(), AllMessages::size);
  ASSERT_EQ(rows.size(), AllMessages::size);
  std::size_t tag = 0;
  AllMessages::forEach([&]<class M>() {
    SCOPED_TRACE(names[tag]);
    EXPECT_EQ(rows[tag][1].str(), std::to_string(tag));
    EXPECT_EQ(rows[tag][2].str(), names[tag]);
    EXPECT_EQ(rows[tag][3].str(), M::isFact ? "fact" : "work");
    EXPECT_EQ(rows[tag][4].str(), std::to_string(1 + encode(M{}).size()));
    ++tag;
  });
}

TEST(WireFormat, TheDocumentHasTheVersionOfTheCode) {
  EXPECT_NE(document().find("u8, now " + std::to_string(kWireVersion) + "\n"), std::string::npos);
}

TEST(WireFormat, APacketThatEndsTooEarlyIsRefused) {
  const Bytes bytes = exampleOfDocument();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Receiver receiver;
    Traffic traffic;
    receivePacket(receiver, TaskId{1}, std::span(bytes).first(size), traffic);
    const bool betweenMessages = size == 5 || size == 112 || size == 126;
    EXPECT_EQ(traffic.refused, betweenMessages ? 0u : 1u) << size;
  }
}

}  // namespace
}  // namespace rayshade
