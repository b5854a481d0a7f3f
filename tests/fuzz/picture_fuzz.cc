// Any bytes at all as a picture.  For libFuzzer: `make fuzz`.
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>

#include "tests/fuzz/any_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rayshade::takeAnyPicture({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
