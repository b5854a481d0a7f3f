// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/shared_bytes.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace rayshade {
namespace {

constexpr std::uint64_t kAlignment = 1 << 16;  // at least a page, whatever the machine: mappings begin there

[[noreturn]] void failed(const char* doing) {
  throw std::runtime_error(std::string("cannot ") + doing +
                           " shared memory: " + std::generic_category().message(errno));
}

}  // namespace

MappedBytes mapShared(const SharedPlace& place, std::uint64_t size) {
  if (size == 0 || place.offset % kAlignment != 0) return nullptr;
  const std::string path =
      "/proc/" + std::to_string(place.process) + "/fd/" + std::to_string(place.descriptor);
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return nullptr;
  struct stat status {};
  const int seals = fcntl(descriptor, F_GET_SEALS);  // other files have none
  void* at = MAP_FAILED;
  if (seals >= 0 && (seals & F_SEAL_SHRINK) != 0 && fstat(descriptor, &status) == 0 &&
      place.offset <= static_cast<std::uint64_t>(status.st_size) &&
      size <= static_cast<std::uint64_t>(status.st_size) - place.offset)
    at = mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, static_cast<off_t>(place.offset));
  close(descriptor);
  if (at == MAP_FAILED) return nullptr;
  return MappedBytes(static_cast<const std::uint8_t*>(at),
                     [size](const std::uint8_t* bytes) { munmap(const_cast<std::uint8_t*>(bytes), size); });
}

void readShared(const SharedPlace& place, std::span<std::uint8_t> to) {
  for (std::uint64_t at = place.offset; !to.empty();) {
    const ssize_t n = pread(place.descriptor, to.data(), to.size(), static_cast<off_t>(at));
    if (n <= 0) failed("read");
    at += static_cast<std::uint64_t>(n);
    to = to.subspan(static_cast<std::size_t>(n));
  }
}

SharedBytes::SharedBytes() : descriptor_(memfd_create("rayshade", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
  if (descriptor_ < 0 || fcntl(descriptor_, F_ADD_SEALS, F_SEAL_SHRINK) != 0) failed("make");
}

SharedBytes::~SharedBytes() { close(descriptor_); }

SharedPlace SharedBytes::begin() {
  end_ = (end_ + kAlignment - 1) / kAlignment * kAlignment;
  return {static_cast<std::int32_t>(getpid()), descriptor_, end_};
}

void SharedBytes::write(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
  end_ = std::max(end_, offset + bytes.size());
  while (!bytes.empty()) {
    const ssize_t n = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n <= 0) failed("write");
    offset += static_cast<std::uint64_t>(n);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

}  // namespace rayshade
