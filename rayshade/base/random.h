// Randomness without a stream.
//
// A RandomKey is a hash of where a ray is in the picture and in its tree of rays: frame, pixel, sample, path.
// Every random number on the way is a pure function of the key and a dimension, so it does not matter in
// which order, or in which task, the numbers are asked for. Mixing function: the finalizer of SplitMix64
// (Steele, Lea & Flood, Fast Splittable Pseudorandom Number Generators, 2014); every bit of the input changes
// every bit of the output with probability close to 1/2.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>

namespace rayshade {

enum class RandomKey : std::uint64_t {};

// What a random number is used for: two uses of one key never share a number.
enum class Dimension : std::uint32_t {
  firstCell,
  jitterX,
  jitterY,
  time,
  lensX,
  lensY,
  lightU,
  lightV,
  glossX,
  glossY,
};

// The ways in which a path goes on.
enum class Branch : std::uint32_t { transmitted = 1, reflected = 2, light = 3 /* + number of the light */ };

constexpr std::uint64_t mixBits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

constexpr RandomKey child(RandomKey key, std::uint64_t branch) {
  return RandomKey{mixBits(static_cast<std::uint64_t>(key) ^ mixBits(branch))};
}
constexpr RandomKey child(RandomKey key, Branch branch, std::uint32_t index = 0) {
  return child(key, static_cast<std::uint64_t>(branch) + index);
}

// The key of a sample of the picture.  The seed is turned by half its bits, so that frame 1 with seed 2 is not frame 2 with
// seed 1.
constexpr RandomKey frameKey(std::uint64_t seed, std::uint32_t frame) {
  return child(RandomKey{mixBits(std::rotl(seed, 32))}, frame);
}
constexpr RandomKey pixelKey(RandomKey frame, std::uint32_t x, std::uint32_t y) {
  return child(frame, static_cast<std::uint64_t>(y) << 32 | x);
}
constexpr RandomKey sampleKey(RandomKey frame, std::uint32_t x, std::uint32_t y, std::uint32_t cell) {
  return child(pixelKey(frame, x, y), cell);
}
constexpr RandomKey sampleKey(std::uint64_t seed, std::uint32_t frame, std::uint32_t x, std::uint32_t y,
                              std::uint32_t cell) {
  return sampleKey(frameKey(seed, frame), x, y, cell);
}

// The key of one use of a key.  `index` tells apart several of the same kind.
constexpr RandomKey useKey(RandomKey key, Dimension dimension, std::uint32_t index = 0) {
  const std::uint64_t use = static_cast<std::uint64_t>(dimension) << 32 | index;
  return RandomKey{mixBits(static_cast<std::uint64_t>(key) + mixBits(~use))};
}

// Uniform in [0, 1), a multiple of 2^-53.
constexpr double uniform(RandomKey key, Dimension dimension, std::uint32_t index = 0) {
  return static_cast<double>(static_cast<std::uint64_t>(useKey(key, dimension, index)) >> 11) * 0x1p-53;
}

}  // namespace rayshade
