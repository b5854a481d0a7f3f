// Height fields in files: either byte order, and bad ones.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "rayshade/shapes/height_field.h"
#include "tests/support/program.h"
#include "tests/support/text_arguments.h"

namespace rayshade {
namespace {

std::optional<HeightField> parsed(const std::string& name) {
  TextArguments arguments(name);
  return HeightField::parse(arguments);
}

class HeightFieldFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(name_); }
  void write(std::int32_t size, std::size_t heights, std::size_t spareBytes = 0) {
    std::ofstream file(name_, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&size), sizeof size);
    const float height = 0.25f;
    for (std::size_t i = 0; i < heights; ++i)
      file.write(reinterpret_cast<const char*>(&height), sizeof height);
    for (std::size_t i = 0; i < spareBytes; ++i) file.put(0);
  }
  std::string failure() {
    TextArguments arguments(name_);
    try {
      HeightField::parse(arguments);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  }
  const std::string name_ = testing::TempDir() + "height_field_test_" + std::to_string(getpid()) + ".hf";
};

TEST_F(HeightFieldFile, IsReadRowByRow) {
  const auto field = parsed("tests/support/hills.hf");
  ASSERT_TRUE(field);
  EXPECT_EQ(field->heights->size, 9);
  EXPECT_EQ(field->heights->values.size(), 81u);
  EXPECT_EQ(field->heights->values[40], -2000);
  write(3, 9);
  EXPECT_EQ(failure(), "none");
}

TEST_F(HeightFieldFile, ThatPromisesMoreThanItHoldsIsRefused) {
  write(30000, 1, 2);
  EXPECT_EQ(failure(), name_ + ": not enough height-field data");
  write(0x7fffffff, 1);
  EXPECT_EQ(failure(), name_ + ": not enough height-field data");
  write(3, 8, 3);
  EXPECT_EQ(failure(), name_ + ": not enough height-field data");
}

TEST_F(HeightFieldFile, MayHaveTheOtherByteOrder) {
  const auto here = parsed("tests/support/hills.hf");
  ASSERT_TRUE(here);
  std::string bytes = readText("tests/support/hills.hf");
  for (std::size_t i = 0; i + 3 < bytes.size(); i += 4) {
    std::swap(bytes[i], bytes[i + 3]);
    std::swap(bytes[i + 1], bytes[i + 2]);
  }
  std::ofstream(name_, std::ios::binary) << bytes;
  const auto other = parsed(name_);
  ASSERT_TRUE(other);
  EXPECT_EQ(encode(*other), encode(*here));
  std::ofstream(name_, std::ios::binary) << bytes << "more";  // a size that fits neither order exactly
  EXPECT_EQ(encode(*parsed(name_)), encode(*here));
  std::ofstream(name_, std::ios::binary) << bytes.substr(0, bytes.size() - 1);
  EXPECT_EQ(failure(), name_ + ": not enough height-field data");
}

TEST_F(HeightFieldFile, IsReadInTheOrderThatFitsExactly) {
  write(0x02000000, 4);  // 2 in the other order
  EXPECT_EQ(parsed(name_)->heights->size, 2);
  write(0x00010000, 256 * 256);  // 256 in the other order
  EXPECT_EQ(parsed(name_)->heights->size, 256);
  write(2, 4, 7);
  EXPECT_EQ(parsed(name_)->heights->size, 2);
}

TEST_F(HeightFieldFile, ThatIsNoFieldIsRefused) {
  write(1, 1);
  EXPECT_NE(failure().find(name_), std::string::npos);
  write(-5, 25);
  EXPECT_NE(failure().find(name_), std::string::npos);
  std::filesystem::remove(name_);
  EXPECT_EQ(failure(), name_ + ": cannot be read as a height field");
  std::ofstream(name_).close();
  EXPECT_EQ(failure(), name_ + ": not enough height-field data");
}

}  // namespace
}  // namespace rayshade
