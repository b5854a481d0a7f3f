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
inline Float4 all(float x) { return Float4{x, x, x, x}; }

}  // namespace rayshade

// Before a function: it is compiled for several kinds of x86 processor, and the one at hand is chosen when the program
// starts.  The bits are the same for all (no fused operations, see the Makefile).  Sanitizers cannot start such programs.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define RAYSHADE_FOR_THIS_PROCESSOR \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define RAYSHADE_FOR_THIS_PROCESSOR
#endif
