// docs/wire-format.md says what the code does: its example is decoded, its list of messages is compared.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
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
  PacketMemory memory;
  auto write = [&]<class M>(M& message) {
    Writer writer(again);
    writer(static_cast<std::uint8_t>(PositionIn<M, AllMessages>::value));
    serializeInPacket(writer, message, memory);
  };
  write(receiver.rays[0]);
  write(receiver.answers[0]);
  write(receiver.answers[1]);
  EXPECT_EQ(again, bytes);
}

// A message as it stands in the code, because a program does not know the names of its types.
struct MessageInSource {
  std::string name, file;
  bool listed = false;
};

// By tag.
std::multimap<std::size_t, MessageInSource> messagesInSource() {
  std::multimap<std::size_t, MessageInSource> messages;
  for (const auto& entry : std::filesystem::directory_iterator("pvm/messages")) {
    const std::string file = entry.path().string(), source = textOf(file.c_str());
    std::set<std::string> listed;
    const std::regex list("using [A-Za-z]*Messages =\\s*TypeList<([^>]*)>"), name("[A-Za-z]+");
    for (std::sregex_iterator at(source.begin(), source.end(), list), end; at != end; ++at) {
      const std::string inside = (*at)[1];
      for (std::sregex_iterator word(inside.begin(), inside.end(), name); word != end; ++word)
        listed.insert(word->str());
    }
    const std::regex message(
        "\nstruct ([A-Za-z]+) \\{[^}]*?\\bbool isFact = (true|false);([^}]*?\\btag = ([0-9]+);)?");
    for (std::sregex_iterator at(source.begin(), source.end(), message), end; at != end; ++at) {
      const std::string found = (*at)[1];
      EXPECT_TRUE((*at)[3].matched) << found << " in " << file << " has no tag";
      const std::size_t tag = (*at)[3].matched ? std::stoul((*at)[4]) : 999;
      messages.insert({tag, {found, file, listed.contains(found)}});
    }
  }
  return messages;
}

TEST(WireFormat, EveryMessageIsInTheListOfItsFile) {
  const auto messages = messagesInSource();
  for (const auto& [tag, message] : messages)
    EXPECT_TRUE(message.listed) << "the message " << message.name
                                << " is in no list: append it to the list at the end of " << message.file;
  EXPECT_EQ(messages.size(), AllMessages::size) << "pvm/messages: struct with isFact, and AllMessages";
}

TEST(WireFormat, TheListHasEveryMessageWithItsTagKindAndLeastSize) {
  const std::string text = document();
  const std::regex row("\n(- [0-9]+ `[A-Za-z]+`, (fact|work), [0-9]+)(?=[:\n])");
  std::set<std::string> rows;
  for (std::sregex_iterator at(text.begin(), text.end(), row), end; at != end; ++at) rows.insert((*at)[1]);
  const auto messages = messagesInSource();
  AllMessages::forEach([&]<class M>() {
    const auto named = messages.find(M::tag);
    ASSERT_NE(named, messages.end()) << "no struct in pvm/messages has tag " << int(M::tag);
    std::ostringstream wanted;
    wanted << "- " << int(M::tag) << " `" << named->second.name << "`, " << (M::isFact ? "fact" : "work")
           << ", " << 1 + encode(M{}).size();
    EXPECT_EQ(rows.erase(wanted.str()), 1u)
        << "docs/wire-format.md, list of messages: it must have a line that begins " << wanted.str();
  });
  for (const std::string& left : rows)
    ADD_FAILURE() << "docs/wire-format.md, list of messages: no message is " << left;
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
    const bool betweenMessages = size == 5 || size == 104 || size == 108;
    EXPECT_EQ(traffic.refused, betweenMessages ? 0u : 1u) << size;
  }
}

}  // namespace
}  // namespace rayshade
