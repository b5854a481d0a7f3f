// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/noise.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

constexpr int kPeriod = 4096;
constexpr std::uint32_t kPeriodMask = kPeriod - 1;

// The numbers 0 .. 4095, shuffled by the generator drand48 started with srand48(1).  An element is swapped
// with any element, not only with one that has not had its turn: not a fair shuffle, but rayshade's.
constexpr std::array<std::uint16_t, kPeriod> shuffledNumbers() {
  std::array<std::uint16_t, kPeriod> numbers{};
  for (int i = 0; i < kPeriod; ++i) numbers[i] = static_cast<std::uint16_t>(i);
  std::uint64_t state = 0x1330e;
  for (int i = kPeriod - 1; i > 0; --i) {
    state = (0x5deece66du * state + 0xb) & 0xffffffffffffu;
    const std::uint64_t j = state >> 36;  // the uppermost 12 of 48 bits
    const std::uint16_t swapped = numbers[i];
    numbers[i] = numbers[j];
    numbers[j] = swapped;
  }
  return numbers;
}

// What a corner needs: a value and a gradient, four numbers in a row, for each of 256 hashes and three
// components that start four numbers apart.
constexpr int kValues = 256 + 2 * 4 + 3;

// Number i is a CRC-16/ARC (polynomial 0xa001 reflected, started with 0) over three copies of the double
// 0.12345 i, low byte first, brought to [-1, 1).
constexpr std::array<double, kValues> cornerValues() {
  std::array<double, kValues> values{};
  for (int i = 0; i < kValues; ++i) {
    const auto bits = std::bit_cast<std::uint64_t>(i * 0.12345);
    std::uint32_t crc = 0;
    for (int byte = 0; byte < 24; ++byte) {
      crc ^= bits >> (byte % 8 * 8) & 0xff;
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xa001u : 0u);
    }
    values[i] = crc * 2 / 65536.0 - 1;
  }
  return values;
}

constexpr std::array<std::uint16_t, kPeriod> kShuffled = shuffledNumbers();
constexpr std::array<double, kValues> kCornerValues = cornerValues();

// Where a coordinate lies between the lattice planes.
struct LatticePlace {
  std::uint32_t low, high;  // of the planes on both sides, modulo the period
  double fraction;          // from the lower one
  double weight;            // of the upper one
};

LatticePlace placeOf(double coordinate) {
  constexpr double kShift = 1e6;  // of the original, which cuts towards zero and so needs positive numbers
  constexpr double kLargest = 0x1p62;  // fits an integer; there are no fractions out there anyway
  const double shifted = coordinate + kShift;
  if (!(std::abs(shifted) < kLargest)) return {0, 1, 0, 0};
  auto cell = static_cast<std::int64_t>(shifted);
  if (static_cast<double>(cell) > shifted) --cell;  // differs from rayshade4: goes on below -1e6
  const double fraction = shifted - static_cast<double>(cell);
  const auto low = static_cast<std::uint32_t>(cell) & kPeriodMask;
  return {low, (low + 1) & kPeriodMask, fraction, fraction * fraction * (3 - 2 * fraction)};
}

// Calls corner(values, weight, offset) for the eight corners around p: the values of the corner's hash, the
// corner's weight, and p as seen from the corner.
template <class Corner>
void forEachCorner(Vec3 p, Corner corner) {
  const LatticePlace x = placeOf(p.x), y = placeOf(p.y), z = placeOf(p.z);
  for (const bool xHigh : {false, true}) {
    const std::uint32_t hashX = kShuffled[xHigh ? x.high : x.low];
    const double weightX = xHigh ? x.weight : 1 - x.weight;
    const double offsetX = xHigh ? x.fraction - 1 : x.fraction;
    for (const bool yHigh : {false, true}) {
      const std::uint32_t hashXY = kShuffled[hashX ^ (yHigh ? y.high : y.low)];
      const double weightXY = weightX * (yHigh ? y.weight : 1 - y.weight);
      const double offsetY = yHigh ? y.fraction - 1 : y.fraction;
      for (const bool zHigh : {false, true}) {
        const std::uint32_t hash = kShuffled[hashXY ^ (zHigh ? z.high : z.low)] & 0xffu;
        corner(&kCornerValues[hash], weightXY * (zHigh ? z.weight : 1 - z.weight),
               Vec3{offsetX, offsetY, zHigh ? z.fraction - 1 : z.fraction});
      }
    }
  }
}

double linear(const double* values, Vec3 offset) {
  return 0.5 * values[0] + values[1] * offset.x + values[2] * offset.y + values[3] * offset.z;
}

int octavesOf(int wanted) { return wanted < kMostOctaves ? wanted : kMostOctaves; }

}  // namespace

double noise(Vec3 p) {
  double sum = 0;
  forEachCorner(p, [&sum](const double* values, double weight, Vec3 offset) {
    sum += weight * linear(values, offset);
  });
  return sum;
}

Vec3 vectorNoise(Vec3 p) {
  Vec3 sum;
  forEachCorner(p, [&sum](const double* values, double weight, Vec3 offset) {
    sum = sum + weight * Vec3{linear(values, offset), linear(values + 4, offset), linear(values + 8, offset)};
  });
  return sum;
}

double chaos(Vec3 p, int octaves) {
  double sum = 0, scale = 1;
  for (int i = 0; i < octavesOf(octaves); ++i, scale *= 2) sum += noise(p * scale) / scale;
  return sum;
}

double absoluteChaos(Vec3 p, int octaves) {
  double sum = 0, scale = 1;
  for (int i = 0; i < octavesOf(octaves); ++i, scale *= 2) sum += std::abs(noise(p * scale) / scale);
  return sum;
}

Spectrum fractionalSpectrum(double hurst, double lambda, int octaves) {
  return {hurst, lambda, elementary::pow(lambda, -0.5 * (1 + 2 * hurst)), octaves};
}

double fractionalMotion(Vec3 p, const Spectrum& spectrum) {
  double sum = 0, amplitude = 1;
  for (int i = 0; i < octavesOf(spectrum.octaves); ++i) {
    sum += amplitude * noise(p);
    amplitude *= spectrum.omega;
    p = p * spectrum.lambda;
  }
  return sum;
}

Vec3 vectorFractionalMotion(Vec3 p, const Spectrum& spectrum) {
  constexpr double kFaint = 1e-5;  // rayshade leaves out what is fainter, but not in the scalar sum
  Vec3 sum;
  double amplitude = 1;
  for (int i = 0; i < octavesOf(spectrum.octaves) && amplitude >= kFaint; ++i) {
    sum = sum + amplitude * vectorNoise(p);
    amplitude *= spectrum.omega;
    p = p * spectrum.lambda;
  }
  return sum;
}

}  // namespace rayshade
