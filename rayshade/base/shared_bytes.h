// Bytes that all processes of a machine can read, once in its memory.
//
// They lie in a file that has no name (memfd_create(2)): others open it through the process that made it (proc(5), /proc/PID/fd),
// and when the last one has ended or let go, by whatever death, nothing is left of it.  It is sealed against shrinking, so that whoever has
// mapped it is safe.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace rayshade {

// Where bytes lie on this machine.
struct SharedPlace {
  std::int32_t process = 0, descriptor = 0;
  std::uint64_t offset = 0;
};

template <class Archive>
void serialize(Archive& archive, SharedPlace& p) {
  archive(p.process, p.descriptor, p.offset);
}

// Read-only; null: there are not so many bytes at this place, or it is no place for such bytes.
using MappedBytes = std::shared_ptr<const std::uint8_t[]>;
MappedBytes mapShared(const SharedPlace& place, std::uint64_t size);

// Bytes at a place of this very process, without mapping them: what is mapped and read counts as its memory.  Throws
// std::runtime_error.
void readShared(const SharedPlace& place, std::span<std::uint8_t> to);

// Where a process puts bytes for others.  They go when it is gone, except for those who have mapped them.
class SharedBytes {
 public:
  SharedBytes();  // throws std::runtime_error, as all do, when the system has no memory
  ~SharedBytes();
  SharedBytes(const SharedBytes&) = delete;
  SharedBytes& operator=(const SharedBytes&) = delete;

  // Room behind all that is there.  Only what is written takes memory; of room that was not written to its end only that part exists.
  SharedPlace begin();
  void write(std::uint64_t offset, std::span<const std::uint8_t> bytes);

 private:
  int descriptor_;
  std::uint64_t end_ = 0;
};

}  // namespace rayshade
