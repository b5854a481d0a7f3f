// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/shade_ledger.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayshade {
namespace {

using Verdict = ShadeLedger::Verdict;

// Three light points - one dark, one known, one pending - and both secondary rays.
Expect expectation(RecordId record) {
  Expect e;
  e.record = record;
  e.hit.lit.resize(3);
  e.hit.lit[0] = Lit::no;
  e.hit.lit[1] = Lit::asked;
  e.hit.lit[2] = Lit::asked;
  e.hit.transmitted = e.hit.reflected = true;
  e.known.push_back({1, 2, 3});
  e.pending.push_back(2);
  e.to = {TaskId{5}, 77, 4};
  return e;
}

const std::vector<Answer> kAnswers{
    {9, 2, {.1, .2, .3}}, {9, kTransmittedSlot, {.4, .5, .6}}, {9, kReflectedSlot, {.7, .8, .9}}};

void expectWhole(const Settled& settled) {
  EXPECT_EQ(settled.to.record, 77u);
  ASSERT_EQ(settled.gathered.light.size(), 3u);
  EXPECT_EQ(settled.gathered.light[1], (Color{1, 2, 3}));
  EXPECT_EQ(settled.gathered.light[2], (Color{.1, .2, .3}));
  EXPECT_EQ(settled.gathered.transmitted, (Color{.4, .5, .6}));
  EXPECT_EQ(settled.gathered.reflected, (Color{.7, .8, .9}));
}

TEST(ShadeLedger, AnyOrderOfArrivalGivesTheSame) {
  // Position 3 stands for the intersection itself, which a colour may overtake.
  std::vector<std::size_t> order{0, 1, 2, 3};
  int orders = 0;
  do {
    ShadeLedger ledger;
    ledger.begin(3);
    Settled settled;
    for (std::size_t i = 0; i < 4; ++i) {
      const Verdict verdict =
          order[i] == 3 ? ledger.expect(expectation(9), settled) : ledger.arrive(kAnswers[order[i]], settled);
      ASSERT_EQ(verdict, i == 3 ? Verdict::settled : Verdict::waiting) << "orders so far: " << orders;
    }
    expectWhole(settled);
    EXPECT_EQ(ledger.open(), 0u);
    ++orders;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(orders, 24);
}

TEST(ShadeLedger, WhatLacksNothingIsSettledAtOnce) {
  ShadeLedger ledger;
  ledger.begin(0);
  Settled settled;
  Expect e;
  e.record = 1;
  e.to.record = 6;
  EXPECT_EQ(ledger.expect(std::move(e), settled), Verdict::settled);
  EXPECT_EQ(settled.to.record, 6u);
  EXPECT_EQ(ledger.open(), 0u);
}

TEST(ShadeLedger, WhatDoesNotFitIsRefused) {
  Settled settled;
  ShadeLedger ledger;
  ledger.begin(2);
  EXPECT_EQ(ledger.expect(expectation(9), settled), Verdict::refused)
      << "three light points where there are two";
  ledger.begin(3);
  Expect many = expectation(9);
  many.known.push_back({0, 0, 0});
  EXPECT_EQ(ledger.expect(std::move(many), settled), Verdict::refused)
      << "more known colours than lights asked";
  Expect few = expectation(9);
  few.known.clear();
  EXPECT_EQ(ledger.expect(std::move(few), settled), Verdict::refused) << "a known colour is missing";
  Expect wrong = expectation(9);
  wrong.pending[0] = 0;
  EXPECT_EQ(ledger.expect(std::move(wrong), settled), Verdict::refused)
      << "a pending light that was not asked";
  EXPECT_EQ(ledger.open(), 0u);

  EXPECT_EQ(ledger.expect(expectation(9), settled), Verdict::waiting);
  EXPECT_EQ(ledger.expect(expectation(9), settled), Verdict::refused) << "the same record twice";
  EXPECT_EQ(ledger.arrive({9, 1, kWhite}, settled), Verdict::refused) << "a slot that nothing is awaited in";
  EXPECT_EQ(ledger.arrive(kAnswers[0], settled), Verdict::waiting);
  EXPECT_EQ(ledger.arrive(kAnswers[0], settled), Verdict::refused) << "the same slot twice";
  EXPECT_EQ(ledger.arrive(kAnswers[1], settled), Verdict::waiting);
  EXPECT_EQ(ledger.arrive(kAnswers[2], settled), Verdict::settled);
  expectWhole(settled);
}

TEST(ShadeLedger, ANewEpochForgetsEverything) {
  ShadeLedger ledger;
  ledger.begin(3);
  Settled settled;
  ledger.expect(expectation(9), settled);
  ledger.arrive({10, 0, kWhite}, settled);
  EXPECT_EQ(ledger.open(), 2u);
  ledger.begin(3);
  EXPECT_EQ(ledger.open(), 0u);
  EXPECT_EQ(ledger.arrive(kAnswers[0], settled), Verdict::waiting) << "early again";
}

}  // namespace
}  // namespace rayshade
