// guarded: juggles packets
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/in_flight.h"

#include <gtest/gtest.h>

namespace rayshade {
namespace {

SampleId sampleAt(std::int32_t x) { return {x, 0, 0}; }

TEST(InFlight, EachSampleComesHomeOnce) {
  InFlight<SampleId> flying;
  for (std::int32_t x = 0; x < 4; ++x) {
    EXPECT_EQ(flying.next(), static_cast<RecordId>(x));
    flying.add(sampleAt(x));
  }
  EXPECT_EQ(flying.take(2), sampleAt(2));
  EXPECT_EQ(flying.take(2), std::nullopt);
  EXPECT_EQ(flying.take(4), std::nullopt) << "never set out";
  EXPECT_EQ(flying.size(), 3u);
  EXPECT_EQ(flying.take(0), sampleAt(0));
  EXPECT_EQ(flying.take(0), std::nullopt);
  EXPECT_EQ(flying.take(1), sampleAt(1));
  EXPECT_EQ(flying.span(), 1u) << "only the last is left";
  EXPECT_EQ(flying.take(3), sampleAt(3));
  EXPECT_EQ(flying.size(), 0u);
  EXPECT_EQ(flying.next(), 4u);
}

TEST(InFlight, WhatIsTakenBackComesInOrderAndItsNumbersAreNotUsedAgain) {
  InFlight<SampleId> flying;
  for (std::int32_t x = 0; x < 5; ++x) flying.add(sampleAt(x));
  flying.take(1);
  EXPECT_EQ(flying.takeAll(), (std::vector<SampleId>{sampleAt(0), sampleAt(2), sampleAt(3), sampleAt(4)}));
  EXPECT_EQ(flying.size(), 0u);
  EXPECT_EQ(flying.take(3), std::nullopt) << "an answer that comes late";
  EXPECT_EQ(flying.next(), 5u);
}

}  // namespace
}  // namespace rayshade
