// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/image_file.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <fstream>

#include "tests/support/pixels.h"
#include "tests/support/scratch_directory.h"

namespace rayshade {
namespace {

Bytes bytesOf(std::string_view text) {
  const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

Image imageOf(const Bytes& bytes) {
  SharedBytes shared;  // goes; what is mapped stays
  auto read = decodeImage(bytes, "p", shared);
  if (const auto* problem = std::get_if<FileProblem>(&read)) {
    ADD_FAILURE() << problem->message;
    return {};
  }
  EXPECT_TRUE(isPossible(std::get<Image>(read)));
  return std::get<Image>(read);
}

std::string problemOf(const Bytes& bytes) {
  SharedBytes shared;
  const auto read = decodeImage(bytes, "p", shared);
  return std::holds_alternative<FileProblem>(read) ? std::get<FileProblem>(read).message : "";
}

// A PNG with the rows given from the top, as they are packed in the file.
struct PngSpec {
  std::uint32_t width = 0, height = 0;
  int depth = 8, type = PNG_COLOR_TYPE_RGB;
  int interlace = PNG_INTERLACE_NONE;
  std::vector<Pixels> rows;
  std::vector<png_color> palette;
  Pixels paletteAlpha;
};

Bytes pngOf(PngSpec spec) {
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  auto write = [](png_structp to, png_bytep data, std::size_t size) {
    auto& bytes = *static_cast<Bytes*>(png_get_io_ptr(to));
    const auto* const begin = reinterpret_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  png_set_write_fn(png, &out, write, nullptr);
  png_set_IHDR(png, info, spec.width, spec.height, spec.depth, spec.type, spec.interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!spec.palette.empty())
    png_set_PLTE(png, info, spec.palette.data(), static_cast<int>(spec.palette.size()));
  if (!spec.paletteAlpha.empty())
    png_set_tRNS(png, info, spec.paletteAlpha.data(), static_cast<int>(spec.paletteAlpha.size()), nullptr);
  png_write_info(png, info);
  std::vector<png_bytep> rows;
  for (Pixels& row : spec.rows) rows.push_back(row.data());
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

PngSpec rgbSpec() {
  return {.width = 2,
          .height = 2,
          .rows = {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}},
          .palette = {},
          .paletteAlpha = {}};
}

TEST(GenericImage, IsALineAndTheBytesInTheirOrder) {
  const Image image = imageOf(bytesOf("2 1\nabcdef"));
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 1);
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(pixelsOf(image), (Pixels{'a', 'b', 'c', 'd', 'e', 'f'}));
  EXPECT_EQ(*image.pixel(1, 0), 'd');
}

TEST(GenericImage, MayHaveBytesToSpareAndPixelsThatLookLikeText) {
  EXPECT_EQ(pixelsOf(imageOf(bytesOf("1 1\n\n 7 more"))), (Pixels{'\n', ' ', '7'}));
}

TEST(GenericImage, ThatIsTooShortIsRefusedBeforeMemoryIsTaken) {
  EXPECT_EQ(problemOf(bytesOf("2 1\nabcde")), "p: too short for 2 by 1 pixels");
  EXPECT_NE(problemOf(bytesOf("1000000 1000000\nabc")), "");
}

TEST(GenericImage, WithABadFirstLineIsRefused) {
  for (const char* text : {"", "\n", "2\nabc", "0 1\nabc", "-1 1\nabc", "1 1", "1 1 255\nabc", "P4\n1 1\nabc",
                           "99999999999 1\nabc", "4000000000 4000000000\nabc", "1.5 1\nabc"})
    EXPECT_EQ(problemOf(bytesOf(text)).rfind("p: ", 0), 0u) << text;
}

TEST(PngImage, StandsUpright) {
  const Image image = imageOf(pngOf(rgbSpec()));
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(pixelsOf(image), (Pixels{7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6}));
}

TEST(PngImage, MayBeInterlaced) {
  PngSpec spec = rgbSpec();
  spec.interlace = PNG_INTERLACE_ADAM7;
  spec.rows.clear();
  spec.width = spec.height = 9;
  Pixels expected;
  for (int y = 0; y < 9; ++y) {
    spec.rows.emplace_back();
    for (int x = 0; x < 27; ++x) spec.rows.back().push_back(static_cast<std::uint8_t>(y * 27 + x));
  }
  for (int y = 8; y >= 0; --y) expected.insert(expected.end(), spec.rows[y].begin(), spec.rows[y].end());
  EXPECT_EQ(pixelsOf(imageOf(pngOf(spec))), expected);
}

TEST(PngImage, KeepsGrayAndAlpha) {
  PngSpec spec = rgbSpec();
  spec.height = 1;
  spec.type = PNG_COLOR_TYPE_GRAY;
  spec.rows = {{1, 200}};
  EXPECT_EQ(imageOf(pngOf(spec)).channels, 1);
  EXPECT_EQ(pixelsOf(imageOf(pngOf(spec))), (Pixels{1, 200}));
  spec.type = PNG_COLOR_TYPE_GRAY_ALPHA;
  spec.rows = {{1, 200, 3, 4}};
  EXPECT_EQ(imageOf(pngOf(spec)).channels, 2);
  spec.type = PNG_COLOR_TYPE_RGB_ALPHA;
  spec.rows = {{1, 2, 3, 4, 5, 6, 7, 8}};
  EXPECT_EQ(imageOf(pngOf(spec)).channels, 4);
  EXPECT_EQ(pixelsOf(imageOf(pngOf(spec))), (Pixels{1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(PngImage, SpreadsFewBitsAndRoundsSixteen) {
  PngSpec spec = rgbSpec();
  spec.height = 1;
  spec.type = PNG_COLOR_TYPE_GRAY;
  spec.depth = 1;
  spec.rows = {{0x40}};
  EXPECT_EQ(pixelsOf(imageOf(pngOf(spec))), (Pixels{0, 255}));
  spec.depth = 16;
  spec.rows = {{0x80, 0x80, 0x00, 0xff}};  // 32896 / 257 = 128, 255 / 257 = 0.99
  EXPECT_EQ(pixelsOf(imageOf(pngOf(spec))), (Pixels{128, 1}));
}

TEST(PngImage, LooksUpPalettes) {
  PngSpec spec = rgbSpec();
  spec.height = 1;
  spec.type = PNG_COLOR_TYPE_PALETTE;
  spec.palette = {{1, 2, 3}, {4, 5, 6}};
  spec.rows = {{1, 0}};
  EXPECT_EQ(pixelsOf(imageOf(pngOf(spec))), (Pixels{4, 5, 6, 1, 2, 3}));
  spec.paletteAlpha = {9};
  EXPECT_EQ(pixelsOf(imageOf(pngOf(spec))), (Pixels{4, 5, 6, 255, 1, 2, 3, 9}));
}

TEST(PngImage, CutAnywhereIsRefusedOrWhole) {
  const Bytes whole = pngOf(rgbSpec());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(problemOf(cut).rfind("p: ", 0), 0u) << size;
  }
}

TEST(PngImage, WithAnyByteChangedDoesNoHarm) {
  const Bytes whole = pngOf(rgbSpec());
  SharedBytes shared;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (std::uint8_t change : {0x01, 0x80, 0xff}) {
      Bytes changed = whole;
      changed[at] ^= std::byte{change};
      decodeImage(changed, "p", shared);
    }
  }
}

TEST(PngImage, ThatClaimsMoreThanItCanHoldIsRefused) {
  Bytes bytes = pngOf(rgbSpec());
  // Width and height of the header become 65536 each; its checksum is made right again.
  const std::size_t kSize = 16, kType = 12, kChecksum = 29;
  for (std::size_t i : {kSize, kSize + 4}) {
    bytes[i + 1] = std::byte{1};
    bytes[i + 3] = std::byte{0};
  }
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = kType; i < kChecksum; ++i) {
    crc ^= std::to_integer<std::uint32_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  for (std::size_t i = 0; i < 4; ++i) bytes[kChecksum + i] = static_cast<std::byte>(~crc >> (24 - 8 * i));
  EXPECT_EQ(problemOf(bytes), "p: too short for 65536 by 65536 pixels");
}

TEST(ImageFile, ThatIsMissingOrADirectoryIsNamed) {
  SharedBytes shared;
  const auto missing = readImage("/nowhere/p.png", shared);
  ASSERT_TRUE(std::holds_alternative<FileProblem>(missing));
  EXPECT_EQ(std::get<FileProblem>(missing).message, "/nowhere/p.png: no such file");
  EXPECT_TRUE(std::holds_alternative<FileProblem>(readImage("/", shared)));
  EXPECT_TRUE(std::holds_alternative<FileProblem>(readImage("/dev/zero", shared)));
}

TEST(ImageFile, ThatIsLargeIsReadFromACopyWithTheSamePixels) {
  const ScratchDirectory scratch("image-file");
  std::string text = "900 800\n";
  while (text.size() < 9 + 900 * 800 * 3) text += static_cast<char>(text.size() * 31 >> 3);
  std::ofstream(scratch / "large.mtv", std::ios::binary) << text;
  SharedBytes shared;
  const auto read = readImage(scratch / "large.mtv", shared);
  ASSERT_TRUE(std::holds_alternative<Image>(read)) << std::get<FileProblem>(read).message;
  EXPECT_TRUE(pixelsOf(std::get<Image>(read)) == pixelsOf(imageOf(bytesOf(text))));
}

TEST(Image, IdsTellSizesAndPixelsApart) {
  const auto idOf = [](const char* text) { return imageOf(bytesOf(text)).id; };
  EXPECT_EQ(idOf("2 1\nabcdef"), idOf("2 1\nabcdef"));
  EXPECT_NE(idOf("2 1\nabcdef"), idOf("2 1\nabcdeg"));
  EXPECT_NE(idOf("2 1\nabcdef"), idOf("1 2\nabcdef"));
}

TEST(Image, OfAnImpossibleSizeIsNotDecoded) {
  const Bytes good = encode(imageOfPixels(2, 1, 1, {1, 2}));
  ASSERT_TRUE(decode<Image>(good));
  EXPECT_EQ(encode(*decode<Image>(good)), good);
  EXPECT_FALSE(decode<Image>(encode(Image{})));
  EXPECT_FALSE(decode<Image>(encode(imageOfPixels(-1, -2, 1, {}))));
  EXPECT_FALSE(decode<Image>(encode(imageOfPixels(1, 2, 5, {}))));
  EXPECT_FALSE(decode<Image>(encode(imageOfPixels(2'000'000, 1, 1, {}))));
}

}  // namespace
}  // namespace rayshade
