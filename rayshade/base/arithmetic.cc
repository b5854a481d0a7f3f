// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/arithmetic.h"

#include <bit>
#include <cmath>
#include <initializer_list>

#include "rayshade/base/elementary.h"
#include "rayshade/base/random.h"

namespace rayshade {

std::uint64_t arithmeticFingerprint() {
  std::uint64_t hash = 0;
  const auto add = [&hash](double value) { hash = mixBits(hash ^ std::bit_cast<std::uint64_t>(value)); };
  const RandomKey key = sampleKey(1, 2, 3, 4, 5);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const double x = uniform(key, Dimension::jitterX, i), y = 20 * uniform(key, Dimension::jitterY, i);
    for (const double of : {elementary::exp(-y), elementary::expm1(-x), elementary::log(x),
                            elementary::pow(x, y), elementary::cbrt(y), elementary::hypot(x, y)})
      add(of);
    for (const double of :
         {elementary::sin(y), elementary::cos(1e9 * y), elementary::tan(x), elementary::asin(x),
          elementary::acos(-x), elementary::atan(y), elementary::atan2(x, -y)})
      add(of);
    add(std::sqrt(y));
    add(std::fma(x, y, x));
    add(x * y + x);  // tells a fused multiply-add
    add(static_cast<float>(x) * static_cast<float>(y) + static_cast<float>(x));
  }
  return hash;
}

}  // namespace rayshade
