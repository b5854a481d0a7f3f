// Messages on their way out, gathered into packets.
//
// One packet per destination is open; it goes when it is full, or when its task flushes (event_loop.h).  Measured on one
// host: 0.15 million rays a second with one ray per packet, 3 million with 64, 10 million with 512 (64 KB).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unordered_map>

#include "pvm/messages/all.h"

namespace rayshade {

struct Traffic {
  std::uint64_t messagesIn = 0, messagesOut = 0, packetsIn = 0, packetsOut = 0, bytesIn = 0, bytesOut = 0;
  std::uint64_t refused = 0, stale = 0;
};

class Outbox {
 public:
  static constexpr std::size_t kFull = 48 * 1024;  // bytes; leaves room for a last large message below 64 KB
  static constexpr std::size_t kRoom = 4 * 1024;   // for the last message, as a rule

  explicit Outbox(Link& link) : link_(link) {}

  template <class M>
  void post(TaskId to, const M& message) {
    static_assert(kIsIn<M, AllMessages>,
                  "this is not in the list of messages: append it to the list at the end of the file in "
                  "pvm/messages where it stands");
    Open& open = packetTo(to);
    const std::size_t before = open.bytes.size();
    {
      Writer writer(open.bytes);
      writer(M::tag);
      serializeInPacket(writer, const_cast<M&>(message), open.memory);  // a Writer reads only
    }
    posted(open, M::tag, open.bytes.size() - before);
  }

  // What is the same for all is encoded once.
  template <class M>
  void postToAll(std::span<const TaskId> tasks, const M& message) {
    static_assert(kIsIn<M, AllMessages> && M::isFact, "work looks at what is before it in its packet");
    Bytes encoded;
    Writer{encoded}(M::tag, message);
    for (const TaskId to : tasks) {
      Open& open = packetTo(to);
      open.bytes.insert(open.bytes.end(), encoded.begin(), encoded.end());
      posted(open, M::tag, encoded.size());
    }
  }

  void flush() {
    for (auto& [key, open] : open_)
      if (!open.bytes.empty()) send(open);
  }

  // Packets carry their epoch, so what is open belongs to the old one and goes first.
  void beginEpoch(Epoch epoch) {
    flush();
    open_.clear();
    last_ = nullptr;
    epoch_ = epoch;
  }

  // Notes an event of now, if a record is kept.
  void note(EventKind kind, TaskId peer, std::uint32_t number, std::uint32_t count, std::uint64_t amount) {
    if (record != nullptr)
      record->at(link_.now(), kind, static_cast<std::int32_t>(peer), number, count, amount);
  }

  Traffic traffic;
  EventRecord* record = nullptr;  // null: nothing is recorded

 private:
  struct Open {
    TaskId to = kNobody;
    Bytes bytes;
    PacketMemory memory;
    struct Content {
      std::uint32_t messages = 0, bytes = 0;
    };
    std::array<Content, AllMessages::size> contents{};  // of the open packet by tag, if a record is kept
  };
  Open& packetTo(TaskId to) {
    if (last_ == nullptr || last_->to != to) {
      last_ = &open_[static_cast<std::int32_t>(to)];
      last_->to = to;
    }
    if (last_->bytes.empty()) {
      last_->bytes.reserve(kFull + kRoom);
      Writer{last_->bytes}(kWireVersion, epoch_);
      last_->memory = {};
    }
    return *last_;
  }
  void posted(Open& open, std::uint8_t tag, std::size_t bytes) {
    ++traffic.messagesOut;
    if (record != nullptr) {
      ++open.contents[tag].messages;
      open.contents[tag].bytes += static_cast<std::uint32_t>(bytes);
    }
    if (open.bytes.size() >= kFull) send(open);
  }
  void send(Open& open) {
    const double begin = record != nullptr ? link_.now() : 0;
    traffic.bytesOut += open.bytes.size();
    ++traffic.packetsOut;
    link_.send(open.to, open.bytes);
    if (record != nullptr) recordPacket(open, begin);
    open.bytes.clear();
    if (open.bytes.capacity() > 2 * kFull) open.bytes = Bytes{};  // one large message does not stay in memory
  }

  void recordPacket(Open& open, double begin);

  Link& link_;
  Epoch epoch_{};
  std::unordered_map<std::int32_t, Open> open_;  // node-based: last_ stays valid
  Open* last_ = nullptr;
  std::unordered_map<std::int32_t, std::uint32_t> packetsTo_;  // that went while a record was kept
};

}  // namespace rayshade
