// Bytes for all processes of a machine: found where they are, and nowhere else.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/shared_bytes.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

namespace rayshade {
namespace {

const std::array<std::uint8_t, 4> kBytes{7, 8, 9, 10};

SharedPlace written(SharedBytes& shared) {
  const SharedPlace place = shared.begin();
  shared.write(place.offset, kBytes);
  return place;
}

TEST(SharedBytes, AreMappedAndReadWhereTheyLie) {
  SharedBytes shared;
  written(shared);
  const SharedPlace second = written(shared);
  EXPECT_GT(second.offset, 0u);
  const MappedBytes mapped = mapShared(second, kBytes.size());
  ASSERT_TRUE(mapped);
  std::array<std::uint8_t, 2> read{};
  SharedPlace later = second;
  later.offset += 2;
  readShared(later, read);
  for (std::size_t i = 0; i < kBytes.size(); ++i) EXPECT_EQ(mapped[i], kBytes[i]);
  EXPECT_EQ(read, (std::array<std::uint8_t, 2>{9, 10}));
}

TEST(SharedBytes, AreSeenByAnotherProcessAndOutliveTheirOwner) {
  auto shared = std::make_unique<SharedBytes>();
  const SharedPlace place = written(*shared);
  const pid_t child = fork();
  if (child == 0) {
    const MappedBytes mapped = mapShared(place, kBytes.size());
    _exit(mapped && mapped[3] == kBytes[3] ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  const MappedBytes mapped = mapShared(place, kBytes.size());
  shared.reset();
  EXPECT_EQ(mapped[0], kBytes[0]);
  EXPECT_FALSE(mapShared(place, kBytes.size()));  // its owner has let go
}

TEST(SharedBytes, AreNotMappedBeyondTheirEnd) {
  SharedBytes shared;
  SharedPlace place = written(shared);
  for (std::uint64_t size : {std::uint64_t{0}, std::uint64_t{5}, ~std::uint64_t{0}})
    EXPECT_FALSE(mapShared(place, size)) << size;
  for (std::uint64_t offset : {std::uint64_t{1}, std::uint64_t{1} << 16, ~std::uint64_t{0} << 16}) {
    place.offset = offset;
    EXPECT_FALSE(mapShared(place, 1)) << offset;
  }
}

TEST(SharedBytes, AreNotWhateverElseAProcessHasOpen) {
  const auto self = static_cast<std::int32_t>(getpid());
  const int file = open("/proc/self/exe", O_RDONLY);
  EXPECT_FALSE(mapShared({self, file, 0}, 1));  // could become shorter
  EXPECT_FALSE(mapShared({self, -1, 0}, 1));
  EXPECT_FALSE(mapShared({0, 0, 0}, 1));
  close(file);
}

}  // namespace
}  // namespace rayshade
