// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/option_values.h"

#include <gtest/gtest.h>

#include <string>

namespace rayshade {
namespace {

// Just above the middle of two doubles: who rounds first to a long double of 64 bits gets the lower one.
TEST(OptionValues, ANumberIsTheNearestDoubleOnEveryProcessor) {
  double value = 0;
  CLI::App app;
  app.add_option("--number", value)->transform(numberFrom(0, 2));
  app.parse("--number 1.00000000000000011102230246251565404236316680908203126", false);
  EXPECT_EQ(value, 1 + 0x1p-52);
}

}  // namespace
}  // namespace rayshade
