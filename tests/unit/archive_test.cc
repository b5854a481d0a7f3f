// Values to bytes and back, and bytes that nobody wrote.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/archive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rayshade/base/color.h"
#include "rayshade/base/inline_vector.h"
#include "rayshade/base/vec.h"

namespace rayshade {
namespace {

Bytes bytesOf(std::initializer_list<int> values) {
  Bytes bytes;
  for (int v : values) bytes.push_back(static_cast<std::byte>(v));
  return bytes;
}

enum class Fruit : std::uint16_t { apple = 1, pear = 0x0203 };

struct Basket {
  Fruit fruit = Fruit::apple;
  std::string label;
  std::vector<Vec3> places;
  std::optional<double> weight;
  std::variant<std::int32_t, std::string> price;
  bool sold = false;
  friend bool operator==(const Basket&, const Basket&) = default;
};
template <class Archive>
void serialize(Archive& archive, Basket& b) {
  archive(b.fruit, b.label, b.places, b.weight, b.price, b.sold);
}

Basket fullBasket() {
  return {Fruit::pear, "Williams", {{1, 2, 3}, {-0.0, 1e300, 5e-324}}, 0.5, std::string("much"), true};
}

TEST(Archive, NumbersAreLittleEndianWithoutPadding) {
  EXPECT_EQ(encode(std::uint32_t{0x01020304}), bytesOf({4, 3, 2, 1}));
  EXPECT_EQ(encode(std::int16_t{-2}), bytesOf({0xfe, 0xff}));
  EXPECT_EQ(encode(1.0), bytesOf({0, 0, 0, 0, 0, 0, 0xf0, 0x3f}));
  EXPECT_EQ(encode(true), bytesOf({1}));
  EXPECT_EQ(encode(Fruit::pear), bytesOf({3, 2}));
}

TEST(Archive, TextAndListsHaveTheirCountInFront) {
  EXPECT_EQ(encode(std::string("ab")), bytesOf({2, 0, 0, 0, 'a', 'b'}));
  EXPECT_EQ(encode(std::vector<std::uint8_t>{7, 8, 9}), bytesOf({3, 0, 0, 0, 7, 8, 9}));
  EXPECT_EQ(encode(std::vector<std::string>{"", "c"}), bytesOf({2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 'c'}));
  EXPECT_EQ((encode(std::array<std::uint8_t, 2>{5, 6})), bytesOf({5, 6}));
}

TEST(Archive, AlternativesHaveTheirPositionInFront) {
  EXPECT_EQ((encode(std::variant<std::uint8_t, std::uint16_t>{std::uint16_t{9}})), bytesOf({1, 9, 0}));
  EXPECT_EQ(encode(std::optional<std::uint8_t>{}), bytesOf({0}));
  EXPECT_EQ(encode(std::optional<std::uint8_t>{4}), bytesOf({1, 4}));
}

TEST(Archive, WhatWasWrittenIsRead) {
  EXPECT_EQ(decode<Basket>(encode(Basket{})), Basket{});
  EXPECT_EQ(decode<Basket>(encode(fullBasket())), fullBasket());
}

TEST(Archive, DoublesKeepEveryBit) {
  for (const double value : {0.0, -0.0, 0.1, 5e-324, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    const auto back = decode<double>(encode(value));
    ASSERT_TRUE(back);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(*back), std::bit_cast<std::uint64_t>(value));
  }
}

TEST(Archive, AnyPrefixAndAnyTailIsRefused) {
  Bytes bytes = encode(fullBasket());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode<Basket>(std::span(bytes).first(size))) << size;
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decode<Basket>(bytes));
}

TEST(Archive, ACountThatTheBytesCannotHoldTakesNoMemory) {
  const Bytes bytes = bytesOf({0xff, 0xff, 0xff, 0xff, 1, 2, 3});
  EXPECT_FALSE(decode<std::string>(bytes));
  EXPECT_FALSE(decode<std::vector<double>>(bytes));
  EXPECT_FALSE(decode<std::vector<Vec3>>(bytes));
  EXPECT_FALSE((decode<InlineVector<double, 4>>(bytes)));
  // 3 doubles need 24 bytes, not 23.
  Bytes almost = encode(std::vector<double>{1, 2, 3});
  almost.pop_back();
  Reader reader(almost);
  std::vector<double> list;
  reader(list);
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(list.capacity(), 0u);
}

TEST(Archive, ATruthIsZeroOrOneAndATagIsInItsList) {
  EXPECT_FALSE(decode<bool>(bytesOf({2})));
  EXPECT_FALSE(decode<std::optional<bool>>(bytesOf({2, 1})));
  EXPECT_FALSE((decode<std::variant<bool, std::uint8_t>>(bytesOf({2, 1}))));
}

TEST(Archive, AFailedReaderYieldsZerosAndStaysFailed) {
  const Bytes bytes = bytesOf({1, 2, 3});
  Reader reader(bytes);
  std::uint32_t number = 77;
  std::uint8_t next = 77;
  std::string text = "before";
  bool truth = true;
  reader(number, next, text, truth);
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.left(), 0u);
  EXPECT_EQ(number, 0u);
  EXPECT_EQ(next, 0u);
  EXPECT_EQ(text, "");
  EXPECT_FALSE(truth);
}

struct Usually {
  double zero = 0, one = 1;
  std::vector<std::uint8_t> list;
};
template <class Archive>
void serialize(Archive& archive, Usually& u) {
  serializeSparse(archive, Usual{u.zero, 0.0}, Usual{u.one, 1.0}, Usual{u.list, std::vector<std::uint8_t>{}});
}

TEST(SparseArchive, OnlyWhatIsUnusualTakesSpace) {
  EXPECT_EQ(encode(Usually{}), bytesOf({0, 0}));
  EXPECT_EQ(encode(Usually{0, 1, {5}}), bytesOf({4, 0, 1, 0, 0, 0, 5}));
  EXPECT_EQ(encode(Usually{0, 2, {}}).size(), 2u + 8u);
}

TEST(SparseArchive, WhatIsUsualIsRestoredOverWhateverWasThere) {
  Usually value{7, 7, {7}};
  const Bytes bytes = encode(Usually{});
  Reader reader(bytes);
  reader(value);
  EXPECT_EQ(value.zero, 0);
  EXPECT_EQ(value.one, 1);
  EXPECT_TRUE(value.list.empty());
}

TEST(SparseArchive, MinusZeroAndNotANumberAreUnusual) {
  const auto zero = decode<Usually>(encode(Usually{-0.0, 1, {}}));
  ASSERT_TRUE(zero);
  EXPECT_TRUE(std::signbit(zero->zero));
  const auto nan = decode<Usually>(encode(Usually{0, std::nan(""), {}}));
  ASSERT_TRUE(nan);
  EXPECT_TRUE(std::isnan(nan->one));
}

struct Light {
  Color color;
};
template <class Archive>
void serialize(Archive& archive, Light& l) {
  serializeCompact(archive, l.color);
}

TEST(CompactColor, BlackAndWhiteAreOneByte) {
  EXPECT_EQ(encode(Light{kBlack}), bytesOf({0}));
  EXPECT_EQ(encode(Light{kWhite}), bytesOf({1}));
  EXPECT_EQ(encode(Light{{1, 1, 0.5}}).size(), 25u);
  for (const Color& color : {kBlack, kWhite, Color{0.25, 1, 7}, Color{-0.0, 0, 0}}) {
    const auto back = decode<Light>(encode(Light{color}));
    ASSERT_TRUE(back);
    EXPECT_TRUE(sameBits(back->color, color));
  }
  EXPECT_FALSE(decode<Light>(bytesOf({3})));
}

TEST(InlineVector, KeepsItsElementsWhereverTheyLie) {
  InlineVector<int, 3> list;
  EXPECT_TRUE(list.empty());
  for (int i = 0; i < 10; ++i) {
    list.push_back(i);
    ASSERT_EQ(list.size(), static_cast<std::size_t>(i) + 1);
    for (int k = 0; k <= i; ++k) ASSERT_EQ(list[static_cast<std::size_t>(k)], k);
  }
  const InlineVector<int, 3> copy = list;
  list.assign(2, 5);
  EXPECT_EQ(list[1], 5);
  EXPECT_EQ(copy.size(), 10u);
  EXPECT_EQ(copy[9], 9);
  list.push_back(6);
  list.push_back(7);
  EXPECT_EQ(std::vector<int>(list.begin(), list.end()), (std::vector<int>{5, 5, 6, 7}));
}

TEST(InlineVector, TravelsLikeAVector) {
  for (std::size_t size : {0u, 2u, 3u, 9u}) {
    InlineVector<std::uint16_t, 3> list;
    std::vector<std::uint16_t> same;
    for (std::size_t i = 0; i < size; ++i) {
      list.push_back(static_cast<std::uint16_t>(i * 1000));
      same.push_back(static_cast<std::uint16_t>(i * 1000));
    }
    EXPECT_EQ(encode(list), encode(same));
    const auto back = decode<InlineVector<std::uint16_t, 3>>(encode(list));
    ASSERT_TRUE(back);
    EXPECT_EQ(std::vector<std::uint16_t>(back->begin(), back->end()), same);
  }
}

}  // namespace
}  // namespace rayshade
