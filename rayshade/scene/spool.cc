// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/spool.h"

#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace rayshade {
namespace {

[[noreturn]] void failed(const char* doing) {
  throw std::runtime_error(std::string("cannot ") + doing +
                           " a temporary file: " + std::generic_category().message(errno));
}

}  // namespace

void Spool::append(std::span<const std::byte> bytes) {
  tail_.insert(tail_.end(), bytes.begin(), bytes.end());
  if (tail_.size() <= kInMemory) return;
  if (!file_) file_.reset(std::tmpfile());
  if (!file_) failed("make");
  const auto at = static_cast<off_t>(onDisk_);
  for (std::size_t done = 0; done < tail_.size();) {
    const ssize_t n = ::pwrite(fileno(file_.get()), tail_.data() + done, tail_.size() - done,
                               at + static_cast<off_t>(done));
    if (n <= 0) failed("write");
    done += static_cast<std::size_t>(n);
  }
  onDisk_ += tail_.size();
  tail_.clear();
}

void Spool::read(std::uint64_t offset, std::span<std::byte> to) {
  while (!to.empty() && offset < onDisk_) {
    const std::size_t want = std::min<std::uint64_t>(to.size(), onDisk_ - offset);
    const ssize_t n = ::pread(fileno(file_.get()), to.data(), want, static_cast<off_t>(offset));
    if (n <= 0) failed("read");
    offset += static_cast<std::uint64_t>(n);
    to = to.subspan(static_cast<std::size_t>(n));
  }
  if (!to.empty()) std::memcpy(to.data(), tail_.data() + (offset - onDisk_), to.size());
}

void Spool::clear() {
  tail_.clear();
  onDisk_ = 0;
}

}  // namespace rayshade
