// A slice of what tests/bench/oracle_fuzz.cc does at length: kernels against the exact answer.
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/oracle/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayshade {
namespace {

class Oracle : public testing::TestWithParam<std::string_view> {};

TEST_P(Oracle, FindsNoFault) {
  constexpr std::string_view kSlow[] = {"polygon", "torus", "blob", "heightfield", "pyramid"};
  const bool slow = std::find(std::begin(kSlow), std::end(kSlow), GetParam()) != std::end(kSlow);
  const std::uint64_t cases = slow ? 1000 : 10000;
  const OracleReport report = examine(GetParam(), 2026, 0, cases);
  EXPECT_EQ(report.failures, 0u) << (report.examples.empty() ? "" : report.examples[0]);
  EXPECT_GT(report.questions, cases / 2);  // it has looked at something
}

struct Found {
  std::uint64_t seed, number;
};
void expectNoFault(std::string_view name, std::span<const Found> cases) {
  for (const auto& [seed, number] : cases) {
    const OracleReport report = examine(name, seed, number, 1);
    EXPECT_EQ(report.failures, 0u) << (report.examples.empty() ? "" : report.examples[0]);
  }
}

// Rays nearly along a generator, that fuzzing has found: hits of a cone that the exact ray passes, itself met again by a
// ray that leaves it along its side, hits that are missed.
TEST(OracleAgain, ConesAlongAGenerator) {
  constexpr Found kCases[] = {{7, 212411},  {7, 239577},  {7, 598894},  {7, 85331},  {7, 381538},
                              {7, 2421530}, {7, 4884111}, {2, 9114735}, {3, 312527}, {3, 8769939}};
  expectNoFault("cone", kCases);
}

// Needles: a hit whose weights had lost four bits, rays that leave along the plane.
TEST(OracleAgain, Needles) {
  constexpr Found kCases[] = {{7, 5663853}, {7, 969890}, {7, 1913301}, {7, 2992655}};
  expectNoFault("phongtriangle", kCases);
  constexpr Found kFlat[] = {{7, 548683}, {7, 817609}, {7, 8529087}};
  expectNoFault("triangle", kFlat);
}

// Rays that leave a height field in a fold, where they start on the other face.
TEST(OracleAgain, Folds) {
  constexpr Found kCases[] = {{7, 1778191}, {7, 1805076}, {7, 4362079}, {7, 7872842}};
  expectNoFault("heightfield", kCases);
}

INSTANTIATE_TEST_SUITE_P(Of, Oracle, testing::ValuesIn(oracleClasses().begin(), oracleClasses().end()),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace rayshade
