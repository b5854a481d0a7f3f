// Pictures are read once.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/image_library.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/pixels.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

std::shared_ptr<const Image> imageIn(ImageLibrary& library, const std::string& file) {
  const auto read = library.read(file);
  const auto* const image = std::get_if<std::shared_ptr<const Image>>(&read);
  return image != nullptr ? *image : nullptr;
}

TEST(ImageLibrary, ReadsAFileOnceUnlessItChanges) {
  const ScratchDirectory scratch("library");
  const std::string file = scratch / "a.mtv";
  std::ofstream(file) << "1 1\nabc";
  ImageLibrary library;
  const auto first = imageIn(library, file);
  ASSERT_TRUE(first);
  EXPECT_EQ(imageIn(library, file), first);
  std::ofstream(file) << "1 1\nabcd";
  const auto second = imageIn(library, file);
  EXPECT_NE(second, first);
  EXPECT_EQ(pixelsOf(*second), pixelsOf(*first));
  EXPECT_EQ(second->id, first->id);
  EXPECT_FALSE(imageIn(library, scratch / "none.mtv"));
}

}  // namespace
}  // namespace rayshade
