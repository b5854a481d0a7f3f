// A directory for one test, in TMPDIR or else /tmp, that goes away with everything in it.
//
// Where the name would become too long for the names of PVM's sockets in it, it is in /tmp too.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace rayshade {

class ScratchDirectory {
 public:
  explicit ScratchDirectory(const std::string& name) {
    const std::string last = "/rayshade-" + name + "-" + std::to_string(getpid());
    path_ = std::filesystem::temp_directory_path().string() + last;
    if (path_.size() >= kLongest) path_ = "/tmp" + last;
    std::filesystem::create_directories(path_);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  ~ScratchDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& file) const { return path_ + "/" + file; }

 private:
  static constexpr std::size_t kLongest = 80;  // of the 107 bytes that the name of a socket can have

  std::string path_;
};

}  // namespace rayshade
