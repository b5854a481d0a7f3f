// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>

#include <algorithm>
#include <cstdio>

namespace rayshade {

std::uint64_t memoryOfMachine() {
  struct sysinfo info {};
  return sysinfo(&info) == 0 ? std::uint64_t{info.totalram} * info.mem_unit : 0;
}

std::uint64_t memoryLimit() {
  std::uint64_t least = 0;
  for (const auto resource : {RLIMIT_DATA, RLIMIT_AS}) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) continue;
    least = least == 0 ? limit.rlim_cur : std::min<std::uint64_t>(least, limit.rlim_cur);
  }
  return least;
}

std::string sayBytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f MB", megabytes(bytes));
  return text;
}

void keepMemoryTight() {
  mallopt(M_MMAP_THRESHOLD, 256 * 1024);  // said once, it does not grow
  mallopt(M_TRIM_THRESHOLD, 256 * 1024);
}

}  // namespace rayshade
