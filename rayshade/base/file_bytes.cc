// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/file_bytes.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <vector>

namespace rayshade {
namespace {

constexpr std::size_t kInMemory = std::size_t{1} << 20;

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

// How many bytes were there; less than nothing: errno tells.
std::int64_t copy(std::FILE* from, std::FILE* to, std::size_t most) {
  std::vector<char> block(kInMemory);
  std::size_t size = 0;
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), from)) {
    size += n;
    if (size > most || std::fwrite(block.data(), 1, n, to) != n) return -1;
  }
  return std::ferror(from) != 0 || std::fflush(to) != 0 ? -1 : static_cast<std::int64_t>(size);
}

}  // namespace

std::variant<FileBytes, FileProblem> FileBytes::open(const std::string& name, std::size_t most) {
  FileBytes file;
  std::error_code error;
  const bool large = std::filesystem::is_regular_file(name, error) &&
                     std::filesystem::file_size(name, error) > kInMemory && !error;
  if (!large || std::filesystem::file_size(name, error) > most) {
    auto read = readFile(name, most);
    if (auto* problem = std::get_if<FileProblem>(&read)) return std::move(*problem);
    file.held_ = std::get<Bytes>(std::move(read));
    return file;
  }
  auto problem = [&name](const std::string& doing = "") {
    return FileProblem{name + ": " + doing + std::generic_category().message(errno)};
  };
  const File in(std::fopen(name.c_str(), "rb"));
  if (!in) return problem();
  const File to(std::tmpfile());
  if (!to) return problem("no temporary copy: ");
  const std::int64_t size = copy(in.get(), to.get(), most);
  if (size <= 0) return problem();
  file.size_ = static_cast<std::size_t>(size);
  void* const at = mmap(nullptr, file.size_, PROT_READ, MAP_SHARED, fileno(to.get()), 0);
  if (at == MAP_FAILED) return problem();
  file.mapped_ = std::shared_ptr<const std::byte[]>(
      static_cast<const std::byte*>(at),
      [size = file.size_](const std::byte* bytes) { munmap(const_cast<std::byte*>(bytes), size); });
  return file;
}

void FileBytes::forget() {
  if (mapped_) madvise(const_cast<std::byte*>(mapped_.get()), size_, MADV_DONTNEED);
}

}  // namespace rayshade
