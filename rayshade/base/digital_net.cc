// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/digital_net.h"

#include <algorithm>
#include <array>
#include <utility>

namespace rayshade {
namespace {

constexpr int kMostDigits = 12;  // 2^12 = 64^2 points
constexpr int kSobolCoordinates = 9;

// Column k of a matrix: what digit k of the number (from the lowest) adds to the digits of the coordinate (highest first).
using Matrix = std::array<std::uint32_t, kMostDigits>;

// Primitive polynomials (degree, inner coefficients) and initial numbers of Joe & Kuo's table new-joe-kuo-6.21201.
struct Polynomial {
  int degree;
  std::uint32_t inner;
  std::array<std::uint32_t, 5> initial;
};
constexpr std::array<Polynomial, kSobolCoordinates - 1> kPolynomials{{{1, 0, {1}},
                                                                      {2, 1, {1, 3}},
                                                                      {3, 1, {1, 3, 1}},
                                                                      {3, 2, {1, 1, 1}},
                                                                      {4, 1, {1, 1, 3, 3}},
                                                                      {4, 4, {1, 3, 5, 13}},
                                                                      {5, 2, {1, 1, 5, 5, 17}},
                                                                      {5, 4, {1, 1, 5, 5, 5}}}};

constexpr std::array<Matrix, kSobolCoordinates> sobolMatrices() {
  std::array<Matrix, kSobolCoordinates> matrices{};
  for (int k = 0; k < kMostDigits; ++k) matrices[0][k] = 1u << (kMostDigits - 1 - k);
  for (int d = 1; d < kSobolCoordinates; ++d) {
    const Polynomial& polynomial = kPolynomials[d - 1];
    const int degree = polynomial.degree;
    Matrix& column = matrices[d];
    for (int k = 0; k < kMostDigits; ++k) {
      if (k < degree) {
        column[k] = polynomial.initial[k] << (kMostDigits - 1 - k);
        continue;
      }
      column[k] = column[k - degree] ^ column[k - degree] >> degree;
      for (int i = 1; i < degree; ++i)
        if ((polynomial.inner >> (degree - 1 - i) & 1) != 0) column[k] ^= column[k - i];
    }
  }
  return matrices;
}
constexpr std::array<Matrix, kSobolCoordinates> kSobol = sobolMatrices();

std::uint32_t sobolDigits(std::uint32_t number, std::uint32_t coordinate, int digits) {
  std::uint32_t sum = 0;
  for (int k = 0; k < digits; ++k)
    if ((number >> k & 1) != 0) sum ^= kSobol[coordinate][k];
  return sum >> (kMostDigits - digits);
}

// The digits of the number, the lowest first, are the coefficients of a polynomial.  Those of it shifted by `shift`, the lowest
// first: the highest digits of a coordinate.  No shift: the number backwards (van der Corput's sequence).
template <std::uint32_t kBase>
std::uint32_t faureDigits(std::uint32_t number, std::uint32_t shift, int digits) {
  std::array<std::uint32_t, kMostDigits> c{};
  for (int k = 0; k < digits; ++k, number /= kBase) c[k] = number % kBase;
  for (int first = 0; shift != 0 && first < digits; ++first)
    for (int k = digits - 1; k-- > first;) c[k] = (c[k] + shift * c[k + 1]) % kBase;
  std::uint32_t value = 0;
  for (int k = 0; k < digits; ++k) value = value * kBase + c[k];
  return value;
}

// What follows the digits of the net in two coordinates, random at once because no two points have all of these in common.
std::uint64_t behind(std::uint32_t number, RandomKey key) {
  return mixBits(static_cast<std::uint64_t>(key) + (std::uint64_t{1} << 32) + number);
}

// Owen's scrambling of the digits, the highest first: `node` of the tree of digits is the higher ones behind a 1.  The base is a
// constant so that nothing is divided.
template <std::uint32_t kBase>
std::uint32_t scrambledDigits(std::uint32_t value, std::uint32_t place, RandomKey key) {
  std::uint32_t node = 1, result = 0;
  for (; place > 0; place /= kBase) {
    const std::uint32_t digit = value / place % kBase;
    const std::uint64_t hash = mixBits(static_cast<std::uint64_t>(key) + node);
    const std::uint32_t factor = 1 + static_cast<std::uint32_t>(hash >> 32) % (kBase - 1);
    const std::uint32_t summand = static_cast<std::uint32_t>(hash) % kBase;
    result = result * kBase + (factor * digit + summand) % kBase;
    node = node * kBase + digit;
  }
  return result;
}

// The same in base 2, where a permutation is a bit: those of six digits, 63 nodes, come from one hash.
std::uint32_t scrambledBits(std::uint32_t value, int digits, RandomKey key) {
  constexpr int kAtOnce = 6;
  std::uint32_t flips = 0;
  for (int done = 0; done < digits; done += kAtOnce) {
    const std::uint32_t above = 1u << done | value >> (digits - done);
    const std::uint64_t hash = mixBits(static_cast<std::uint64_t>(key) + above);
    std::uint32_t node = 1;
    for (int k = digits - done; k-- > std::max(digits - done - kAtOnce, 0);
         node = node << 1 | (value >> k & 1))
      flips = flips << 1 | (hash >> node & 1);
  }
  return value ^ flips;
}

}  // namespace

constexpr DigitalNet::DigitalNet(std::int32_t side) : size_(static_cast<std::uint32_t>(side * side)) {
  for (const std::uint8_t base : {2, 3, 5, 7}) {
    std::int32_t rest = side;
    while (rest % base == 0) rest /= base;
    if (rest == 1 && base_ == 2) base_ = base;
  }
  for (; power_ < size_; power_ *= base_) ++digits_;
}

const DigitalNet& DigitalNet::of(std::int32_t side) {
  static constexpr auto kNets = []<std::size_t... kSide>(std::index_sequence<kSide...>) {
    return std::array{DigitalNet(static_cast<std::int32_t>(kSide) + 1)...};
  }
  (std::make_index_sequence<kMostSide>());
  return kNets[static_cast<std::size_t>(side) - 1];
}

std::uint32_t DigitalNet::coordinates() const {
  if (base_ != 2) return base_ + 1u;
  return kSobolCoordinates + (isWhole() ? 1u : 0u);
}

std::uint32_t DigitalNet::digitsOf(std::uint32_t number, std::uint32_t coordinate) const {
  if (isWhole() && coordinate-- == 0) return number;
  switch (base_) {
    case 3:
      return faureDigits<3>(number, coordinate, digits_);
    case 5:
      return faureDigits<5>(number, coordinate, digits_);
    case 7:
      return faureDigits<7>(number, coordinate, digits_);
    default:
      return sobolDigits(number, coordinate, digits_);
  }
}

std::uint32_t DigitalNet::scrambled(std::uint32_t value, RandomKey key) const {
  switch (base_) {
    case 3:
      return scrambledDigits<3>(value, power_ / 3, key);
    case 5:
      return scrambledDigits<5>(value, power_ / 5, key);
    case 7:
      return scrambledDigits<7>(value, power_ / 7, key);
    default:
      return scrambledBits(value, digits_, key);
  }
}

double DigitalNet::coordinate(std::uint32_t number, std::uint32_t coordinate, RandomKey key,
                              std::uint32_t bits) const {
  return (scrambled(digitsOf(number, coordinate), key) + bits * 0x1p-32) * (1.0 / power_);
}

double DigitalNet::coordinate(std::uint32_t number, std::uint32_t coordinate, RandomKey key) const {
  if (coordinate >= coordinates()) return square(number, coordinate, key).x;
  return this->coordinate(number, coordinate, key, static_cast<std::uint32_t>(behind(number, key) >> 32));
}

SquarePoint DigitalNet::square(std::uint32_t number, std::uint32_t coordinate, RandomKey key) const {
  const std::uint64_t bits = behind(number, key);
  if (coordinate + 1 >= coordinates()) {
    number = scrambled(number, child(key, coordinate));
    coordinate = isWhole() ? 1 : 0;
  }
  const RandomKey keyOfY{~static_cast<std::uint64_t>(key)};
  return {this->coordinate(number, coordinate, key, static_cast<std::uint32_t>(bits >> 32)),
          this->coordinate(number, coordinate + 1, keyOfY, static_cast<std::uint32_t>(bits))};
}

}  // namespace rayshade
