// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>

#include "rayshade/image/image_file.h"
#include "tests/fuzz/any_input.h"

namespace rayshade {

void takeAnyPicture(std::span<const std::byte> input) {
  SharedBytes shared;
  const auto read = decodeImage(input, "p", shared);
  const auto* const image = std::get_if<Image>(&read);
  const auto* const problem = std::get_if<FileProblem>(&read);
  if (image != nullptr ? !isPossible(*image) || !image->pixels : problem->message.size() <= 3) std::abort();
}

}  // namespace rayshade
