// Packets in: decoding, the check of epochs, and one `on` per message.
//
// A task lists what it accepts, `using Accepted = TypeList<...>`, and has a member `on(TaskId from, M&& message)` for each;
// a message that is listed and not handled does not compile, nor one that is handled and not listed.  What is not
// listed, malformed or left over at the end of a packet is refused and counted; so is work of another epoch.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/outbox.h"

namespace rayshade {

namespace inbox_detail {

template <class Task, class M>
concept Handles = requires(Task& task, TaskId from, M message) {
  task.on(from, std::move(message));
};

template <class Task, class M>
struct AcceptedBy {
  static_assert(
      kIsIn<M, AllMessages>,
      "`Accepted` of this task names what is not in the list of messages: append it to the list at the "
      "end of the file in pvm/messages where it stands");
  static_assert(Handles<Task, M>, "`Accepted` of this task names a message for which it has no handler on()");
};
template <class Task, class... M>
constexpr bool checkAccepted(TypeList<M...>) {
  return ((sizeof(AcceptedBy<Task, M>) > 0) && ...);
}

// Of a message and all tasks that there are.
template <class M, class... Task>
struct ReceivedBy {
  static_assert((kIsIn<M, typename Task::Accepted> || ...),
                "no task accepts this message: name it in `Accepted` of the one that receives it");
  static_assert(((kIsIn<M, typename Task::Accepted> || !Handles<Task, M>)&&...),
                "a task has a handler on() for this message, but does not name it in its `Accepted`");
};

// Decodes and delivers one message of type M.  False: the packet is malformed.
template <class M, class Task>
bool deliver(Task& task, TaskId from, Epoch epoch, Reader& reader, PacketMemory& before, Traffic& traffic) {
  M message{};
  serializeInPacket(reader, message, before);
  if (!reader.ok()) return false;
  ++traffic.messagesIn;
  if constexpr (kIsIn<M, typename Task::Accepted>) {
    // Epochs are counted from 1: before the first Configure a task has nothing that it could work with.
    if (!M::isFact && (epoch != task.epoch() || epoch == Epoch{})) {
      ++traffic.stale;
    } else {
      task.on(from, std::move(message));
    }
  } else {
    ++traffic.refused;
  }
  return true;
}

// By tag.
template <class Task>
struct Deliveries {
  using Deliver = bool (*)(Task&, TaskId, Epoch, Reader&, PacketMemory&, Traffic&);
  std::array<Deliver, AllMessages::size> of{};
  constexpr Deliveries() {
    std::size_t tag = 0;
    AllMessages::forEach([&]<class M>() { of[tag++] = &deliver<M, Task>; });
  }
};

}  // namespace inbox_detail

// Each message has a task that accepts it, and no handler is in vain.
template <class... Task>
constexpr bool receiveAllMessages() {
  return []<class... M>(TypeList<M...>) {
    return ((sizeof(inbox_detail::ReceivedBy<M, Task...>) > 0) && ...);
  }(AllMessages{});
}

template <class Task>
void receivePacket(Task& task, TaskId from, std::span<const std::byte> bytes, Traffic& traffic) {
  static_assert(inbox_detail::checkAccepted<Task>(typename Task::Accepted{}));
  ++traffic.packetsIn;
  traffic.bytesIn += bytes.size();
  Reader reader(bytes);
  std::uint8_t version = 0;
  Epoch epoch{};
  reader(version, epoch);
  if (!reader.ok() || version != kWireVersion) {
    ++traffic.refused;
    return;
  }
  static constexpr inbox_detail::Deliveries<Task> kDeliveries;
  PacketMemory before;
  while (reader.left() > 0) {
    std::uint8_t tag = 0;
    reader(tag);
    if (tag >= kDeliveries.of.size() || !kDeliveries.of[tag](task, from, epoch, reader, before, traffic)) {
      ++traffic.refused;
      return;
    }
  }
}

}  // namespace rayshade
