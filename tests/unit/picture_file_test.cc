// Pictures: levels, files and back, and that there is never half a file.
//
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/picture_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "tests/support/seeded_random.h"

namespace rayshade {
namespace {

namespace fs = std::filesystem;

// A directory of its own for each test.
class PictureFile : public testing::Test {
 protected:
  PictureFile() {
    std::string pattern = (fs::temp_directory_path() / "picture_test.XXXXXX").string();
    directory_ = mkdtemp(pattern.data());
  }
  ~PictureFile() override {
    std::error_code ignored;
    fs::remove_all(directory_, ignored);
  }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_), {}));
  }
  static std::string bytesOf(const std::string& name) {
    std::ifstream in(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string put(const std::string& content) const {
    std::ofstream(path("input"), std::ios::binary) << content;
    return path("input");
  }

  fs::path directory_;
};

std::vector<std::vector<Color>> randomRows(int width, int height) {
  Random random(5);
  const auto light = [&] { return random.real(-0.2, 1.3); };
  std::vector<std::vector<Color>> rows(static_cast<std::size_t>(height));
  for (auto& row : rows)
    for (int x = 0; x < width; ++x) row.push_back({light(), light(), light()});
  return rows;
}

Picture pictureOf(const std::vector<std::vector<Color>>& rows) {
  Picture picture{static_cast<std::int32_t>(rows[0].size()), static_cast<std::int32_t>(rows.size()), {}};
  for (const auto& row : rows) appendRow(picture, row);
  return picture;
}

void write(const std::string& name, const std::vector<std::vector<Color>>& rows, double gamma = 1,
           std::optional<PictureFormat> format = {}) {
  PictureWriter writer(name, static_cast<std::int32_t>(rows[0].size()),
                       static_cast<std::int32_t>(rows.size()), gamma, format);
  for (const auto& row : rows) writer.row(row);
  writer.finish();
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kHuge = std::numeric_limits<float>::infinity();

TEST(Level, IsCutOffAndNotRounded) {
  const std::pair<float, std::uint32_t> table[] = {
      {0, 0},      {-0.0f, 0},  {-1, 0},       {-kHuge, 0}, {kNan, 0},      {1e-30f, 0}, {0.0039f, 0},
      {0.004f, 1}, {0.5f, 127}, {0.999f, 254}, {1, 255},    {1.0001f, 255}, {kHuge, 255}};
  for (const auto& [light, level] : table) EXPECT_EQ(levelOf(light, 1, 255), level) << light;
  EXPECT_EQ(levelOf(0.5f, 1, 65535), 32767u);
}

TEST(Level, GammaBrightens) {
  // floor(255 x^(1/gamma)), worked out by hand
  EXPECT_EQ(levelOf(0.25f, 2, 255), 127u);
  EXPECT_EQ(levelOf(0.5f, 2.2, 255), 186u);
  EXPECT_EQ(levelOf(0.1f, 2.2, 255), 89u);
  EXPECT_EQ(levelOf(0.5f, 0.5, 255), 63u);
  EXPECT_EQ(levelOf(1, 2.2, 255), 255u);
  EXPECT_EQ(levelOf(7, 2.2, 255), 255u);
  EXPECT_EQ(levelOf(0, 2.2, 255), 0u);
}

TEST(Level, GammaZeroMakesAllBelowOneBlack) {
  EXPECT_EQ(levelOf(0, 0, 255), 0u);
  EXPECT_EQ(levelOf(0.9999f, 0, 255), 0u);
  EXPECT_EQ(levelOf(1, 0, 255), 255u);
  EXPECT_EQ(levelOf(1.5f, 0, 255), 255u);
}

TEST(Level, OfNegativeLightIsBlackForEveryGamma) {
  for (double gamma : {0.0, 0.5, 1.0, 2.2, -1.0, static_cast<double>(kNan)}) {
    EXPECT_EQ(levelOf(-2, gamma, 255), 0u);
    EXPECT_EQ(levelOf(kNan, gamma, 255), 0u);
  }
}

TEST(Checksum, ChangesWithEveryBitAndWithTheShape) {
  Picture picture{2, 1, {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}};
  const std::uint64_t sum = checksum(picture);
  EXPECT_EQ(checksum(picture), sum);
  for (float& light : picture.pixels) {
    const float before = light;
    light = std::nextafter(light, 1.0f);
    EXPECT_NE(checksum(picture), sum);
    light = before;
  }
  std::swap(picture.pixels[0], picture.pixels[1]);
  EXPECT_NE(checksum(picture), sum);
  std::swap(picture.pixels[0], picture.pixels[1]);
  std::swap(picture.width, picture.height);
  EXPECT_NE(checksum(picture), sum);
}

TEST(Checksum, IsTheKnownFunction) {
  // FNV-1a of eight zero bytes.
  EXPECT_EQ(checksum(Picture{}), 0xa8c7f832281a39c5u);
}

TEST(Format, FollowsTheEndOfTheName) {
  EXPECT_EQ(formatOf("a.png"), PictureFormat::png);
  EXPECT_EQ(formatOf("a.ppm"), PictureFormat::ppm);
  EXPECT_EQ(formatOf("a.png.pfm"), PictureFormat::pfm);
  EXPECT_EQ(formatOf("a.PNG"), PictureFormat::png);
  for (const char* name : {"a.mtv", "png", "-", "", "/dev/null", "v1.2/picture"})
    EXPECT_EQ(formatOf(name), PictureFormat::generic) << name;
  for (const char* name : {"a.jpg", "a.rle", "a.png.gz", "a."})
    EXPECT_EQ(formatOf(name), std::nullopt) << name;
}

TEST_F(PictureFile, LevelsComeBackAsTheyWereWritten) {
  const auto rows = randomRows(19, 7);
  const Picture exact = pictureOf(rows);
  const std::pair<PictureFormat, std::uint32_t> formats[] = {{PictureFormat::png, 255},
                                                             {PictureFormat::png16, 65535},
                                                             {PictureFormat::ppm, 255},
                                                             {PictureFormat::generic, 255}};
  for (const auto& [format, most] : formats) {
    write(path("a"), rows, 1, format);
    const Picture read = readPicture(path("a"));
    ASSERT_EQ(read.width, 19);
    ASSERT_EQ(read.height, 7);
    ASSERT_EQ(read.pixels.size(), exact.pixels.size());
    for (std::size_t i = 0; i < read.pixels.size(); ++i)
      EXPECT_EQ(levelOf(read.pixels[i], 1, most), levelOf(exact.pixels[i], 1, most));
  }
}

TEST_F(PictureFile, EveryLevelSurvivesReadingAndWritingAgain) {
  for (auto [format, count] : {std::pair{PictureFormat::ppm, 256}, {PictureFormat::png16, 65536}}) {
    std::vector<std::vector<Color>> rows(1);
    for (int level = 0; level < count; ++level) {
      const double light = (level + 0.5) / (count - 1);
      rows[0].push_back({light, light, light});
    }
    write(path("a"), rows, 1, format);
    const Picture read = readPicture(path("a"));
    for (int level = 0; level < count; ++level)
      ASSERT_EQ(
          levelOf(read.pixels[static_cast<std::size_t>(level) * 3], 1, static_cast<std::uint32_t>(count) - 1),
          static_cast<std::uint32_t>(level));
  }
}

TEST_F(PictureFile, PfmKeepsEveryBit) {
  auto rows = randomRows(5, 4);
  rows[1][2] = {-1e30, 1e-30, static_cast<double>(kHuge)};
  write(path("a.pfm"), rows, 2.2);  // gamma is for levels only
  EXPECT_EQ(readPicture(path("a.pfm")), pictureOf(rows));
}

TEST_F(PictureFile, HasTheBytesOfItsFormat) {
  const std::vector<std::vector<Color>> rows = {{{1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0.5, 0.5, 0.5}}};
  const std::string levels("\xff\0\0\0\xff\0\0\0\xff\x7f\x7f\x7f", 12);
  write(path("a.mtv"), rows);
  EXPECT_EQ(bytesOf(path("a.mtv")), "2 2\n" + levels);
  write(path("a.ppm"), rows);
  EXPECT_EQ(bytesOf(path("a.ppm")), "P6\n2 2\n255\n" + levels);
  write(path("a.pfm"), rows);
  const std::string one("\0\0\x80\x3f", 4), zero(4, 0), half("\0\0\0\x3f", 4);
  EXPECT_EQ(bytesOf(path("a.pfm")), "PF\n2 2\n-1.0\n" + zero + zero + one + half + half + half +  // bottom
                                        one + zero + zero + zero + one + zero);
}

TEST_F(PictureFile, AppearsOnlyWhenComplete) {
  const auto rows = randomRows(3, 2);
  for (const char* name : {"a.png", "a.ppm", "a.pfm", "a.mtv"}) {
    {
      PictureWriter writer(path(name), 3, 2);
      writer.row(rows[0]);
      EXPECT_FALSE(fs::exists(path(name)));
      EXPECT_THROW(writer.finish(), std::logic_error);
    }
    EXPECT_EQ(files(), 0u) << "something is left of " << name;
  }
}

TEST_F(PictureFile, LeavesAnOlderOneAloneUntilComplete) {
  std::ofstream(path("a.ppm")) << "old";
  const auto rows = randomRows(3, 1);
  {
    PictureWriter writer(path("a.ppm"), 3, 1);
    writer.row(rows[0]);
  }
  EXPECT_EQ(bytesOf(path("a.ppm")), "old");
  write(path("a.ppm"), rows);
  EXPECT_EQ(readPicture(path("a.ppm")).width, 3);
  EXPECT_EQ(files(), 1u);
}

TEST_F(PictureFile, GoesWhereALinkPoints) {
  std::ofstream(path("a.ppm")) << "old";
  fs::create_symlink("a.ppm", path("link.ppm"));
  write(path("link.ppm"), randomRows(3, 1));
  EXPECT_TRUE(fs::is_symlink(path("link.ppm")));
  EXPECT_EQ(readPicture(path("a.ppm")).width, 3);
}

TEST_F(PictureFile, HasThePermissionsOfAnyNewFile) {
  std::ofstream(path("other")) << "x";
  write(path("a.png"), randomRows(2, 2));
  EXPECT_EQ(fs::status(path("a.png")).permissions(), fs::status(path("other")).permissions());
}

TEST_F(PictureFile, DoesNotReplaceADevice) {
  write("/dev/null", randomRows(2, 2));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(PictureFile, RefusesAtOnceWhatCannotBeWritten) {
  auto messageOf = [](const std::string& name) -> std::string {
    try {
      PictureWriter writer(name, 2, 2);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(messageOf(path("missing/a.png")).find("missing/a.png"), std::string::npos);
  EXPECT_NE(messageOf(directory_.string()).find("directory"), std::string::npos);
  EXPECT_THROW(PictureWriter(path("a.png"), 0, 2), std::runtime_error);
  EXPECT_THROW(PictureWriter(path("a.png"), 2, -1), std::runtime_error);
  EXPECT_EQ(files(), 0u);
}

TEST_F(PictureFile, ReportsAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const auto rows = randomRows(300, 300);
  for (auto format : {PictureFormat::png, PictureFormat::ppm, PictureFormat::pfm}) {
    try {
      write("/dev/full", rows, 1, format);
      ADD_FAILURE() << "nothing noticed";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("/dev/full: "), std::string::npos) << error.what();
    }
  }
}

TEST_F(PictureFile, RefusesRowsOfTheWrongLengthAndTooMany) {
  PictureWriter writer(path("a.ppm"), 2, 1);
  EXPECT_THROW(writer.row(std::vector<Color>(3)), std::logic_error);
  writer.row(std::vector<Color>(2));
  EXPECT_THROW(writer.row(std::vector<Color>(2)), std::logic_error);
}

TEST_F(PictureFile, ReadsOtherPeoplesHeaders) {
  EXPECT_EQ(readPicture(put("P6 # made by\n# hand\n 1\t1 255 \xff\xff\xff")).pixels,
            (std::vector<float>{1, 1, 1}));
  const Picture wide = readPicture(put(std::string("P6\n1 1\n65535\n\xff\xff\0\0\x80\0", 19)));
  EXPECT_EQ(levelOf(wide.pixels[2], 1, 65535), 0x8000u);
  EXPECT_EQ(readPicture(put(std::string("PF\n1 1\n1.0\n\x3f\x80\0\0\0\0\0\0\x40\0\0\0", 23))).pixels,
            (std::vector<float>{1, 0, 2}));  // big-endian
}

TEST_F(PictureFile, RefusesWhatIsNoPicture) {
  const std::string damaged[] = {"",
                                 "hello",
                                 "P6",
                                 "P6 2 2",
                                 "P6 2 2 255 abc",
                                 "P6 0 2 255 abcdef",
                                 "P6 -1 2 255 abcdef",
                                 "P6 1000000 1000000 255 abc",
                                 "P6 99999999999999999999 1 255 abc",
                                 "P6 1 1 70000 abcdef",
                                 "PF 1000000 1000000 -1 abc",
                                 "1000000 1000000\nabc",
                                 "3x 1\nabcdefghi",
                                 "P6 # no end",
                                 "\x89PNG"};
  for (const std::string& content : damaged)
    EXPECT_THROW(readPicture(put(content)), std::runtime_error) << content;
  EXPECT_THROW(readPicture(path("missing")), std::runtime_error);
  EXPECT_THROW(readPicture(directory_.string()), std::runtime_error);
}

TEST_F(PictureFile, RefusesOrReadsADamagedPng) {
  write(path("a.png"), randomRows(20, 20));
  const std::string good = bytesOf(path("a.png"));
  for (std::size_t size = 0; size + 12 < good.size(); size += 7)
    EXPECT_THROW(readPicture(put(good.substr(0, size))), std::runtime_error) << size;
  SeededRandom random(3);
  for (int i = 0; i < 300; ++i) {
    std::string bad = good;
    bad[random.below(bad.size())] ^= static_cast<char>(1 << random.below(8));
    try {
      EXPECT_LE(readPicture(put(bad)).pixels.size(), 1200u);
    } catch (const std::runtime_error&) {
    }
  }
}

}  // namespace
}  // namespace rayshade
