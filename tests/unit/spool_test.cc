// Bytes that go to disk when they are many.
// guarded: juggles packets
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/spool.h"

#include <gtest/gtest.h>

namespace rayshade {
namespace {

std::byte byteAt(std::uint64_t offset) { return static_cast<std::byte>((offset * 2654435761u) >> 13); }

// Appends the next `size` bytes of the pattern.
void grow(Spool& spool, std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = byteAt(spool.size() + i);
  spool.append(bytes);
}

bool isPattern(Spool& spool, std::uint64_t offset, std::size_t size) {
  Bytes bytes(size);
  spool.read(offset, bytes);
  for (std::size_t i = 0; i < size; ++i)
    if (bytes[i] != byteAt(offset + i)) return false;
  return true;
}

TEST(Spool, FewBytesAreReadBack) {
  Spool spool;
  EXPECT_EQ(spool.size(), 0u);
  grow(spool, 10);
  grow(spool, 0);
  grow(spool, 7);
  EXPECT_EQ(spool.size(), 17u);
  EXPECT_TRUE(isPattern(spool, 0, 17));
  EXPECT_TRUE(isPattern(spool, 9, 3));
  EXPECT_TRUE(isPattern(spool, 17, 0));
}

TEST(Spool, ManyBytesAreReadBackFromDiskAndMemoryAlike) {
  Spool spool;
  while (spool.size() < 5 * Spool::kInMemory / 2) grow(spool, 77777);
  EXPECT_TRUE(isPattern(spool, 0, spool.size()));
  // Wherever the border between the two is, some of these reads cross it.
  for (std::uint64_t offset = 0; offset + 5000 <= spool.size(); offset += 4999)
    EXPECT_TRUE(isPattern(spool, offset, 5000)) << offset;
}

TEST(Spool, ReadingBetweenWritesDisturbsNothing) {
  Spool spool;
  for (int i = 0; i < 40; ++i) {
    grow(spool, 65537);
    ASSERT_TRUE(isPattern(spool, spool.size() / 3, 100)) << i;
  }
  EXPECT_TRUE(isPattern(spool, 0, spool.size()));
}

TEST(Spool, OneAppendMayBeLargerThanMemory) {
  Spool spool;
  grow(spool, 3);
  grow(spool, 3 * Spool::kInMemory);
  grow(spool, 5);
  EXPECT_EQ(spool.size(), 3 * Spool::kInMemory + 8);
  EXPECT_TRUE(isPattern(spool, 0, spool.size()));
}

TEST(Spool, ClearedItBeginsAnew) {
  Spool spool;
  grow(spool, Spool::kInMemory + 1);
  grow(spool, 100);
  spool.clear();
  EXPECT_EQ(spool.size(), 0u);
  const Bytes other{std::byte{1}, std::byte{2}};
  spool.append(other);
  Bytes back(2);
  spool.read(0, back);
  EXPECT_EQ(back, other);
  spool.clear();
  grow(spool, Spool::kInMemory + 9);
  EXPECT_TRUE(isPattern(spool, 0, spool.size()));
}

}  // namespace
}  // namespace rayshade
