// The formats of pictures besides PNG and generic files: what is in them, and that damage is refused.
// guarded: reads bytes of others
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
// jpeglib.h needs FILE.
#include <jpeglib.h>

#include "rayshade/image/image_file.h"
#include "rayshade/image/raster_file.h"
#include "tests/support/pixels.h"
#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

using Levels = std::vector<std::uint16_t>;

std::string problemOf(const std::string& content) {
  try {
    readRaster(content, "p");
  } catch (const std::runtime_error& problem) {
    return problem.what();
  }
  return "";
}

void expectRefusedIfCut(const std::string& whole) {
  EXPECT_EQ(problemOf(whole), "");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(problemOf(whole.substr(0, size)).rfind("p: ", 0), 0u) << size;
}

// Any changed byte is borne; a run of such bytes, too.
void expectToBearDamage(const std::string& whole) {
  SeededRandom random(7);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int change : {0x01, 0x80, 0xff}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      problemOf(damaged);
      damaged.replace(random.below(whole.size()), 2, "\xff\xff");
      problemOf(damaged);
    }
  }
}

// ---- netpbm

TEST(NetpbmRaster, HasGrayAndColorsInBytesAndInWords) {
  EXPECT_EQ(readRaster("P5 2 1 255 ab", "p").levels, (Levels{'a', 'b'}));
  EXPECT_EQ(readRaster("P5 2 1 255 ab", "p").channels, 1);
  EXPECT_EQ(readRaster("P6 1 1 255 abc", "p").levels, (Levels{'a', 'b', 'c'}));
  EXPECT_EQ(readRaster("P2 # gray\n2 1\n15\n3 # dark\n15", "p").levels, (Levels{3, 15}));
  EXPECT_EQ(readRaster("P2 2 1 15 3 15", "p").most, 15u);
  EXPECT_EQ(readRaster("P3\n1 2 9\n0 1 2\n3 4 9\n", "p").levels, (Levels{0, 1, 2, 3, 4, 9}));
}

TEST(NetpbmRaster, MayHaveTwoBytesForALevel) {
  const Raster raster = readRaster(std::string("P5 3 1 1000 \x03\xe8\x00\x01\xff\xff", 18), "p");
  EXPECT_EQ(raster.most, 1000u);
  EXPECT_EQ(raster.levels, (Levels{1000, 1, 1000}));  // more than most is most
}

TEST(NetpbmRaster, IsScaledToEightBitsAndStandsUprightAsATexture) {
  const std::string text = "P2 1 3 1000 1000 500 1";
  SharedBytes shared;
  const auto image = decodeImage(std::as_bytes(std::span(text)), "p", shared);
  EXPECT_EQ(pixelsOf(std::get<Image>(image)), (Pixels{0, 128, 255}));
}

TEST(NetpbmRaster, ThatIsCutOrDamagedIsRefused) {
  expectRefusedIfCut("P6 2 1 255 abcdef");
  expectRefusedIfCut("P3 1 1 9 1 2 3");
  for (const char* text : {"P2 1 1 9 10", "P2 1 1 9 -1", "P2 1 1 9 x", "P5 1 1 0 a", "P5 1 1 65536 ab",
                           "P5x 1 1 9 a", "P2 1000000 1000000 9 1", "P5 0 1 9 a"})
    EXPECT_NE(problemOf(text), "") << text;
}

// ---- Utah RLE

std::string rleOf(int width, int height, int flags, int colors, const std::string& rest) {
  const auto low = [](int n) { return static_cast<char>(n & 0xff); };
  const auto high = [](int n) { return static_cast<char>(n >> 8); };
  std::string file("\x52\xcc\0\0\0\0", 6);
  for (int n : {width, height}) file += {low(n), high(n)};
  file += {low(flags), low(colors), 8, 0, 0};
  return file + rest;
}
constexpr int kClear = 1, kNoBackground = 2, kAlpha = 4, kComments = 8;
const std::string kEnd("\7\0", 2);

TEST(RleRaster, IsFilledFromTheLowestRow) {
  const std::string rows(
      "\0"           // no background
      "\2\0\5\1ab"   // red: two bytes
      "\1\1"         // a line up
      "\2\0\6\1c\0"  // a run of two
      "\7\0",
      17);
  const Raster raster = readRaster(rleOf(2, 2, kNoBackground, 1, rows), "p");
  EXPECT_EQ(raster.width, 2);
  EXPECT_EQ(raster.channels, 1);
  EXPECT_EQ(raster.levels, (Levels{'c', 'c', 'a', 'b'}));
  expectRefusedIfCut(rleOf(2, 2, kNoBackground, 1, rows));
  expectToBearDamage(rleOf(2, 2, kNoBackground, 1, rows));
}

TEST(RleRaster, HasColorsAlphaAndABackground) {
  const std::string rows(
      "xyz"               // background
      "\2\0\5\0r\0"       // red, an odd byte is filled up
      "\2\1\3\1\5\0g\0"   // green: one pixel skipped
      "\2\xff\6\1\x80\0"  // alpha
      "\7\0",
      25);
  EXPECT_EQ(readRaster(rleOf(2, 1, kClear | kAlpha, 3, rows), "p").levels,
            (Levels{'r', 'y', 'z', 0x80, 'x', 'g', 'z', 0x80}));
  // Not cleared to the background: 0.
  EXPECT_EQ(readRaster(rleOf(2, 1, kAlpha, 3, rows), "p").levels, (Levels{'r', 0, 0, 0x80, 0, 'g', 0, 0x80}));
}

TEST(RleRaster, MayHaveLongInstructionsCommentsAndMaps) {
  std::string file = rleOf(300, 1, kNoBackground | kComments, 1,
                           std::string("\0"             // no background
                                       "\1\2\3\4"       // a map of two words
                                       "\3\0abc\0"      // a comment of three letters
                                       "\x43\0\x2a\1"   // skips 298 pixels
                                       "\x46\0\1\0x\0"  // a run of two
                                       "\x41\0\1\0"     // one line up, outside
                                       "\5\0a\0"
                                       "\7\0",
                                       31));
  file[13] = 1;  // maps, of two entries each
  file[14] = 1;
  const Raster raster = readRaster(file, "p");
  ASSERT_EQ(raster.levels.size(), 300u);
  EXPECT_EQ(raster.levels[297], 0);
  EXPECT_EQ(raster.levels[298], 'x');
  EXPECT_EQ(raster.levels[299], 'x');
  expectRefusedIfCut(file);
}

TEST(RleRaster, TakesNothingOutsideOfThePicture) {
  const std::string rows("\0\2\0\6\xffr\0\2\5\6\7x\0\1\2\2\0\6\0y\0\7\0", 23);
  EXPECT_EQ(readRaster(rleOf(2, 1, kNoBackground, 1, rows), "p").levels, (Levels{'r', 'r'}));
}

TEST(RleRaster, ThatSetsItsPixelsAgainAndAgainIsRefused) {
  const std::string once("\2\0\6\1x\0", 6), begin(1, '\0');
  EXPECT_EQ(problemOf(rleOf(2, 1, kNoBackground, 1, begin + once + kEnd)), "");
  EXPECT_EQ(problemOf(rleOf(2, 1, kNoBackground, 1, begin + once + once + kEnd)),
            "p: damaged RLE: sets pixels again and again");
}

TEST(RleRaster, ThatIsNoSuchPictureIsRefused) {
  EXPECT_NE(problemOf(rleOf(2, 1, kNoBackground, 2, "\0" + kEnd)), "");
  EXPECT_NE(problemOf(rleOf(0, 1, kNoBackground, 1, "\0" + kEnd)), "");
  EXPECT_NE(problemOf(rleOf(2, 1, kNoBackground, 1, std::string("\0\x09\0", 3) + kEnd)), "");
  EXPECT_EQ(problemOf(rleOf(65535, 65535, kNoBackground, 3, std::string(1, '\0') + kEnd)),
            "p: too short for 65535 by 65535 pixels");
}

// ---- JPEG

std::string jpegOf(int width, int height, int channels, bool progressive, const std::vector<JSAMPLE>& samples,
                   J_COLOR_SPACE space = JCS_UNKNOWN) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = channels;
  jpeg.in_color_space = space != JCS_UNKNOWN ? space : channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < height; ++y) {
    auto* row = const_cast<JSAMPROW>(&samples[static_cast<std::size_t>(y * width * channels)]);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::string file(reinterpret_cast<char*>(bytes), size);
  std::free(bytes);
  return file;
}

TEST(JpegRaster, IsGrayOrColored) {
  const Raster gray = readRaster(jpegOf(2, 2, 1, false, {200, 200, 200, 200}), "p");
  EXPECT_EQ(gray.channels, 1);
  EXPECT_EQ(gray.levels, (Levels{200, 200, 200, 200}));
  for (bool progressive : {false, true}) {
    const Raster red = readRaster(jpegOf(1, 2, 3, progressive, {255, 0, 0, 255, 0, 0}), "p");
    EXPECT_EQ(red.channels, 3);
    ASSERT_EQ(red.levels.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(red.levels[i], i % 3 == 0 ? 255 : 0, 2);
  }
}

TEST(JpegRaster, StandsAsItIs) {  // white above, black below
  std::vector<JSAMPLE> samples(16 * 16, 255);
  std::fill(samples.begin() + 128, samples.end(), JSAMPLE{0});
  const Raster raster = readRaster(jpegOf(16, 16, 1, false, samples), "p");
  EXPECT_EQ(raster.levels.front(), 255);
  EXPECT_EQ(raster.levels.back(), 0);
}

TEST(JpegRaster, ThatIsCutIsRefused) {
  expectRefusedIfCut(jpegOf(2, 1, 1, false, {1, 200}));
  expectRefusedIfCut(jpegOf(2, 1, 3, true, {1, 200, 3, 9, 255, 80}));
}

TEST(JpegRaster, BearsDamage) {
  std::vector<JSAMPLE> samples;
  for (int i = 0; i < 17 * 9 * 3; ++i) samples.push_back(static_cast<JSAMPLE>(i * 37));
  expectToBearDamage(jpegOf(17, 9, 3, false, samples));
  expectToBearDamage(jpegOf(17, 9, 3, true, samples));
}

TEST(JpegRaster, OfFourInksOrOfAClaimedSizeIsRefused) {
  EXPECT_EQ(problemOf(jpegOf(1, 1, 4, false, {1, 2, 3, 4}, JCS_CMYK)),
            "p: a JPEG that is neither gray nor RGB");
  std::string file = jpegOf(1, 1, 1, false, {1});
  const std::size_t frame = file.find("\xff\xc0");
  ASSERT_NE(frame, file.npos);
  file.replace(frame + 5, 4, "\xf0\xf0\xf0\xf0");  // height and width
  EXPECT_EQ(problemOf(file), "p: too short for 61680 by 61680 pixels");
}

}  // namespace
}  // namespace rayshade
