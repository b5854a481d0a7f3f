// Several numbers at once: the vector extensions of GCC and clang.
//
// All operations go element by element and round as those of single numbers do, so what comes out is the same on every
// machine; a processor without wide registers takes several steps.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace rayshade {

typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));
typedef std::int64_t Long2 __attribute__((vector_size(16)));
typedef float Float8 __attribute__((vector_size(32)));
typedef std::int32_t Int8 __attribute__((vector_size(32)));
typedef std::int64_t Long4 __attribute__((vector_size(32)));
typedef double Double8 __attribute__((vector_size(64)));
typedef std::int64_t Long8 __attribute__((vector_size(64)));

inline Float4 minimum(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 maximum(Float4 a, Float4 b) { return a > b ? a : b; }
inline Float4 splat(float x) { return Float4{x, x, x, x}; }

// Kinds of processor for which the same work is compiled, each with wider registers than the one before.
enum class Processor : std::uint8_t { any, avx2, avx512 };

// Functions for x86 processors that not all have.  Only GCC takes what is inlined into them along, and only into functions
// for at least the processor that all is compiled for (-march=...): so these name what they add, the levels v3 and v4 of
// x86-64.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define RAYSHADE_AVX2 __attribute__((target("avx2,bmi,bmi2,f16c,fma,lzcnt,movbe")))
#define RAYSHADE_AVX512 \
  __attribute__((target("avx2,bmi,bmi2,f16c,fma,lzcnt,movbe,avx512f,avx512bw,avx512cd,avx512dq,avx512vl")))
inline Processor thisProcessor() {
  return __builtin_cpu_supports("x86-64-v4")   ? Processor::avx512
         : __builtin_cpu_supports("x86-64-v3") ? Processor::avx2
                                               : Processor::any;
}
#else
#define RAYSHADE_AVX2
#define RAYSHADE_AVX512
inline Processor thisProcessor() { return Processor::any; }
#endif

template <class Work>
RAYSHADE_AVX2 void onAvx2(Work& work) {
  work();
}
template <class Work>
RAYSHADE_AVX512 void onAvx512(Work& work) {
  work();
}

// Does work that is compiled for each kind of processor: `work` must be a lambda that is always inlined.  The bits are the
// same on all (no fused operations, see the Makefile; tests/property/bundle_hit_test.cc).
template <class Work>
void onProcessor(Processor processor, Work&& work) {
  switch (processor) {
    case Processor::avx512:
      return onAvx512(work);
    case Processor::avx2:
      return onAvx2(work);
    case Processor::any:
      return work();
  }
}
#define RAYSHADE_INLINE __attribute__((always_inline))

}  // namespace rayshade
