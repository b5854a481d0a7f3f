// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/events/event_file.h"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

namespace rayshade {
namespace {

constexpr std::string_view kFirstLine = "rayshade events 1\n";

void put(std::FILE* to, std::span<const std::byte> bytes) { std::fwrite(bytes.data(), 1, bytes.size(), to); }

}  // namespace

void writeHead(std::FILE* to, const std::vector<std::string>& messages) {
  std::fwrite(kFirstLine.data(), 1, kFirstLine.size(), to);
  put(to, encode(messages));
}

void writeLane(std::FILE* to, const EventLane& lane) {
  const Bytes bytes = encode(lane);
  put(to, encode(static_cast<std::uint64_t>(bytes.size())));
  put(to, bytes);
}

EventFile readEvents(const std::string& fileName) {
  std::ifstream in(fileName, std::ios::binary);
  if (!in) throw std::runtime_error(fileName + ": cannot be read");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!text.starts_with(kFirstLine)) throw std::runtime_error(fileName + ": is no file of events");
  const auto all = std::as_bytes(std::span(text));
  Reader reader(all.subspan(kFirstLine.size()));
  EventFile file;
  reader(file.messages);
  while (reader.ok() && reader.left() > 0) {
    const std::size_t at = all.size() - reader.left();
    std::uint64_t size = 0;
    reader(size);
    if (reader.ok() && size <= reader.left()) {
      Reader lane(all.subspan(at + sizeof size, size));
      lane(file.lanes.emplace_back());
      if (lane.ok() && lane.left() == 0) {
        reader = Reader(all.subspan(at + sizeof size + size));
        continue;
      }
    }
    throw std::runtime_error(fileName + ": byte " + std::to_string(at) +
                             ": what a task has done is cut off or damaged");
  }
  if (!reader.ok()) throw std::runtime_error(fileName + ": the names of the messages are cut off");
  return file;
}

}  // namespace rayshade
