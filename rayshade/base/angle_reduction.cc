// Exact reduction: the angle, a whole number times a power of two, is multiplied by 2/pi in whole numbers.  Only those bits
// of 2/pi take part that decide the product modulo 4, and enough below them for an angle nearer to a multiple of pi/2 than
// any double is (2^-61).
//
// Source: Payne & Hanek, Radian reduction for trigonometric functions, SIGNUM Newsletter 18, 1983.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/angle_reduction.h"

#include <array>
#include <cstddef>
#include <limits>

namespace rayshade {
namespace {

// The bits of 2/pi from the point on.
constexpr std::array<std::uint32_t, 38> kTwoOverPi = {
    0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561,
    0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484,
    0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f,
    0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b,
    0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab};

// 32 bits of 2/pi, of which the first stands for 2^-(at + 1); before the point all are 0.
std::uint32_t bitsFrom(int at) {
  const auto word = [](int i) { return i < 0 ? 0 : std::uint64_t{kTwoOverPi[static_cast<std::size_t>(i)]}; };
  const int first = at >> 5;
  return static_cast<std::uint32_t>(((word(first) << 32 | word(first + 1)) << (at & 31)) >> 32);
}

// A fixed point number, its digits of 32 bits from the last one to the first.
constexpr int kDigits = 7;
using Digits = std::array<std::uint32_t, kDigits>;

// A number in [-1/2, 1/2), whose first bit is its sign.
DoubleDouble fractionOf(Digits digits) {
  const bool negative = digits[kDigits - 1] >> 31;
  if (negative) {
    std::uint64_t carry = 1;
    for (std::uint32_t& digit : digits) {
      carry += static_cast<std::uint32_t>(~digit);
      digit = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
  }
  std::size_t top = kDigits - 1;
  double unit = negative ? -0x1p-32 : 0x1p-32;
  for (; top > 3 && digits[top] == 0; --top) unit *= 0x1p-32;
  const auto digit = [&](std::size_t below) { return static_cast<double>(digits[top - below]); };
  const DoubleDouble upper = sumOfOrdered(digit(0), digit(1) * 0x1p-32);
  const DoubleDouble all = sumOfOrdered(upper.high, upper.low + (digit(2) * 0x1p-64 + digit(3) * 0x1p-96));
  return {all.high * unit, all.low * unit};
}

}  // namespace

ReducedAngle reducedExactly(double angle) {
  constexpr int kMantissaBits = 52, kBias = 1023;
  const auto bits = std::bit_cast<std::uint64_t>(angle);
  if ((bits >> kMantissaBits & 0x7ff) == 0x7ff) return {0, {std::numeric_limits<double>::quiet_NaN(), 0}};
  // |angle| = mantissa 2^exponent
  const std::uint64_t mantissa = (bits & 0x000fffffffffffff) | std::uint64_t{1} << kMantissaBits;
  const int exponent = static_cast<int>(bits >> kMantissaBits & 0x7ff) - kBias - kMantissaBits;

  // |angle| 2/pi modulo 4, with two bits before the point: of the product of the mantissa and the bits of 2/pi from
  // that one on that makes 2 of the mantissa's last bit, the last seven digits.
  Digits product{};
  for (std::size_t half = 0; half < 2; ++half) {
    const std::uint64_t factor = half == 0 ? mantissa & 0xffffffff : mantissa >> 32;
    std::uint64_t carry = 0;
    for (std::size_t i = half; i < kDigits; ++i) {
      const int at = exponent - 2 + 32 * (kDigits - 1 - static_cast<int>(i - half));
      carry += factor * bitsFrom(at) + product[i];
      product[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
  }
  // The first 8 bits count steps of pi/128; the rest becomes a number around 0.
  const std::uint32_t first = product[kDigits - 1];
  const unsigned steps = (first >> 24) + (first >> 23 & 1);
  for (std::size_t i = kDigits - 1; i > 0; --i) product[i] = product[i] << 8 | product[i - 1] >> 24;
  product[0] <<= 8;
  const DoubleDouble rest = fractionOf(product) * kAngleStep;
  const bool negative = bits >> 63;
  return {(negative ? kAngleSteps - steps : steps) % kAngleSteps, negative ? -rest : rest};
}

}  // namespace rayshade
