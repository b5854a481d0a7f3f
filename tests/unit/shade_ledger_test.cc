// guarded: answers tasks
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/shade/shade_ledger.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayshade {
namespace {

using Verdict = ShadeLedger::Verdict;

// Three light points - one dark, one known, one pending - and both secondary rays.
Expect expectation(RecordId record) {
  Expect e;
  e.record = record;
  e.hit.visibility.assign(3);
  e.hit.visibility[0] = LightVisibility::none;
  e.hit.visibility[1] = LightVisibility::traced;
  e.hit.visibility[2] = LightVisibility::traced;
  e.hit.back.transmitted = e.hit.back.reflected = true;
  e.gathered.light.assign(3);
  e.gathered.light[1] = {1, 2, 3};
  e.pending.push_back(2);
  e.to = {TaskId{5}, 77, 4};
  return e;
}

const std::vector<Answer> kAnswers{
    {9, 2, {.1, .2, .3}}, {9, kTransmittedSlot, {.4, .5, .6}}, {9, kReflectedSlot, {.7, .8, .9}}};

Verdict arrive(ShadeLedger& ledger, const Answer& answer) {
  return ledger.arrive(answer.record, answer.slot, answer.color);
}

void expectWhole(const CompleteRecord& settled) {
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
    ledger.begin(3, 1);
    for (std::size_t i = 0; i < 4; ++i) {
      const Verdict verdict =
          order[i] == 3 ? ledger.expect(expectation(9)) : arrive(ledger, kAnswers[order[i]]);
      ASSERT_EQ(verdict, i == 3 ? Verdict::complete : Verdict::waiting) << "orders so far: " << orders;
    }
    expectWhole(ledger.complete());
    EXPECT_EQ(ledger.open(), 0u);
    ++orders;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(orders, 24);
}

TEST(ShadeLedger, WhatLacksNothingIsSettledAtOnce) {
  ShadeLedger ledger;
  ledger.begin(0, 1);
  Expect e;
  e.to.record = 6;
  EXPECT_EQ(ledger.expect(std::move(e)), Verdict::complete);
  EXPECT_EQ(ledger.complete().to.record, 6u);
  EXPECT_EQ(ledger.open(), 0u);
}

TEST(ShadeLedger, WhatDoesNotFitIsRefused) {
  ShadeLedger ledger;
  ledger.begin(2, 1);
  EXPECT_EQ(ledger.expect(expectation(9)), Verdict::refused) << "three light points where there are two";
  ledger.begin(3, 1);
  Expect wrong = expectation(9);
  wrong.hit.visibility[0] = static_cast<LightVisibility>(3);
  EXPECT_EQ(ledger.expect(std::move(wrong)), Verdict::refused) << "a light in no known state";
  EXPECT_EQ(ledger.expect(expectation(recordOf(1, 0))), Verdict::refused) << "found by nobody";
  EXPECT_EQ(ledger.expect(expectation(recordOf(0, 1u << 30))), Verdict::refused)
      << "so far ahead that there can't have been so many";
  EXPECT_EQ(ledger.open(), 0u);

  EXPECT_EQ(ledger.expect(expectation(9)), Verdict::waiting);
  EXPECT_EQ(ledger.expect(expectation(9)), Verdict::refused) << "the same record twice";
  EXPECT_EQ(ledger.arrive(9, 1, kWhite), Verdict::refused) << "a slot that nothing is awaited in";
  EXPECT_EQ(arrive(ledger, kAnswers[0]), Verdict::waiting);
  EXPECT_EQ(arrive(ledger, kAnswers[0]), Verdict::refused) << "the same slot twice";
  EXPECT_EQ(arrive(ledger, kAnswers[1]), Verdict::waiting);
  EXPECT_EQ(arrive(ledger, kAnswers[2]), Verdict::complete);
  expectWhole(ledger.complete());
  EXPECT_EQ(arrive(ledger, kAnswers[0]), Verdict::refused) << "a record that is closed";
}

TEST(ShadeLedger, RecordsCloseInAnyOrder) {
  // Out of order, from two finders, more than once around: what is closed makes room, what is open stays.
  ShadeLedger ledger;
  ledger.begin(3, 2);
  for (std::uint64_t round = 0; round < 50; ++round) {
    std::vector<RecordId> records;
    for (std::uint32_t finder : {1u, 0u})
      for (std::uint64_t i = 0; i < 10; ++i)
        records.push_back(recordOf(finder, round * 10 + (i * 7 + 3) % 10));
    for (RecordId record : records) EXPECT_EQ(ledger.expect(expectation(record)), Verdict::waiting);
    EXPECT_EQ(ledger.open(), 20u);
    for (std::size_t i = 0; i < records.size(); ++i) {
      const RecordId record = records[(i * 13 + 5) % records.size()];
      for (const Answer& answer : kAnswers)
        EXPECT_EQ(ledger.arrive(record, answer.slot, answer.color),
                  answer.slot == kReflectedSlot ? Verdict::complete : Verdict::waiting);
      expectWhole(ledger.complete());
    }
    EXPECT_EQ(ledger.open(), 0u);
  }
}

TEST(ShadeLedger, ANewEpochForgetsEverything) {
  ShadeLedger ledger;
  ledger.begin(3, 1);
  ledger.expect(expectation(9));
  ledger.arrive(10, 0, kWhite);
  EXPECT_EQ(ledger.open(), 2u);
  ledger.begin(3, 1);
  EXPECT_EQ(ledger.open(), 0u);
  EXPECT_EQ(arrive(ledger, kAnswers[0]), Verdict::waiting) << "early again";
}

}  // namespace
}  // namespace rayshade
