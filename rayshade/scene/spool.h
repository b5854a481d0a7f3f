// Bytes that may grow beyond memory.
//
// Small ones stay in memory; more than kInMemory go to a temporary file that has no name and so goes with the process.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <span>

#include "rayshade/base/archive.h"

namespace rayshade {

class Spool {
 public:
  static constexpr std::size_t kInMemory = 1 << 20;

  // Throws std::runtime_error when there is no room for temporary files.
  void append(std::span<const std::byte> bytes);
  std::uint64_t size() const { return onDisk_ + tail_.size(); }
  // `size` bytes from `offset`, which must be there.
  void read(std::uint64_t offset, std::span<std::byte> to);
  void clear();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Bytes tail_;  // what is not on disk yet
  std::uint64_t onDisk_ = 0;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace rayshade
