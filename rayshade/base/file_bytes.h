// The content of a file as one run of bytes, of which only what is being read lies in memory.
//
// It is a copy without a name, in the directory of temporary files: of a file that somebody makes shorter meanwhile a mapping
// would break under its reader.  Small ones lie in memory.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "rayshade/base/file.h"

namespace rayshade {

class FileBytes {
 public:
  // Only of regular files, and of at most `most` bytes.
  static std::variant<FileBytes, FileProblem> open(const std::string& name, std::size_t most);

  std::span<const std::byte> bytes() const {
    return mapped_ ? std::span(mapped_.get(), size_) : std::span<const std::byte>(held_);
  }
  void forget();  // what lies in memory; it comes back when it is read again

 private:
  std::shared_ptr<const std::byte[]> mapped_;
  std::size_t size_ = 0;
  Bytes held_;
};

}  // namespace rayshade
