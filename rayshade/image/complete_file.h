// A file that is there as a whole or not at all.
//
// What is written goes to a temporary file beside it, which takes the final name by commit().  Standard output and what is
// not a plain file (a pipe, a device) is written directly.  Throws std::runtime_error with the file's name.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace rayshade {

class CompleteFile {
 public:
  // Finds out whether it can be written at all.  An empty name or "-" is standard output.
  explicit CompleteFile(const std::string& fileName);
  ~CompleteFile();  // an incomplete file goes away
  CompleteFile(const CompleteFile&) = delete;
  CompleteFile& operator=(const CompleteFile&) = delete;

  const std::string& name() const { return name_; }

  // False: errno says why.
  bool put(const void* bytes, std::size_t size) { return std::fwrite(bytes, 1, size, file_) == size; }
  void write(const void* bytes, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  void commit();

 private:
  bool open(const std::string& path, int flags, bool another = false);

  std::string name_, final_, temporary_;
  std::FILE* file_ = nullptr;
};

}  // namespace rayshade
