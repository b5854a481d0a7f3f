// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/image_file.h"

#include <png.h>

#include <charconv>
#include <csetjmp>
#include <cstring>
#include <optional>
#include <string_view>

namespace rayshade {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 31;
constexpr std::size_t kDeflateAtBest = 1032;  // bytes out of one
constexpr int kLargestSide = 1 << 20;

// What libpng works on.  It reports errors by a long jump, so all that owns memory lives out here and not in
// the function that is jumped out of.
struct PngReading {
  std::span<const std::byte> left;
  Image image;
  std::vector<png_bytep> rows;
  std::string problem;
};

void giveBytes(png_structp png, png_bytep to, std::size_t size) {
  auto& reading = *static_cast<PngReading*>(png_get_io_ptr(png));
  if (size > reading.left.size()) png_error(png, "the file is cut off");
  std::memcpy(to, reading.left.data(), size);
  reading.left = reading.left.subspan(size);
}

void noteProblem(png_structp png, png_const_charp message) {
  static_cast<PngReading*>(png_get_error_ptr(png))->problem = message;
  png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

void decodePng(PngReading& reading, png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return;
  const std::size_t fileSize = reading.left.size();
  png_set_read_fn(png, &reading, giveBytes);
  png_set_user_limits(png, kLargestSide, kLargestSide);
  png_read_info(png, info);
  const std::size_t height = png_get_image_height(png, info);
  if (png_get_rowbytes(png, info) * height > kDeflateAtBest * fileSize)
    png_error(png, "too short for the size it claims");
  png_set_expand(png);  // palettes and fewer than 8 bits to 8, a transparent colour to alpha
  png_set_scale_16(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);

  const std::size_t width = png_get_image_width(png, info), channels = png_get_channels(png, info);
  reading.image.width = static_cast<std::int32_t>(width);
  reading.image.height = static_cast<std::int32_t>(height);
  reading.image.channels = static_cast<std::int32_t>(channels);
  reading.image.pixels.resize(width * height * channels);
  reading.rows.resize(height);
  for (std::size_t row = 0; row < height; ++row)
    reading.rows[height - 1 - row] = reading.image.pixels.data() + row * width * channels;
  png_read_image(png, reading.rows.data());
  png_read_end(png, nullptr);
}

std::variant<Image, FileProblem> readPng(std::span<const std::byte> bytes, const std::string& name) {
  PngReading reading;
  reading.left = bytes;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, noteProblem, ignoreWarning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr)
    reading.problem = "libpng cannot be started";
  else
    decodePng(reading, png, info);
  png_destroy_read_struct(&png, &info, nullptr);
  if (!reading.problem.empty()) return FileProblem{name + ": damaged PNG: " + reading.problem};
  return std::move(reading.image);
}

// Takes a whole number above 0 from the front, with the blanks before it.
std::optional<std::int32_t> takeSide(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  std::int32_t side = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
  if (error != std::errc() || side < 1 || side > kLargestSide) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return side;
}

std::variant<Image, FileProblem> readGeneric(std::span<const std::byte> bytes, const std::string& name) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto width = takeSide(text);
  const auto height = width ? takeSide(text) : std::nullopt;
  if (!height) return FileProblem{name + ": neither a PNG nor begins with a line `width height`"};
  const std::size_t endOfLine = text.find_first_not_of(" \r");
  if (endOfLine == text.npos || text[endOfLine] != '\n')
    return FileProblem{name + ": more than width and height in the first line"};
  text.remove_prefix(endOfLine + 1);
  const std::size_t size = std::size_t(*width) * std::size_t(*height) * 3;
  if (text.size() < size)
    return FileProblem{name + ": " + std::to_string(size - text.size()) + " bytes short of " +
                       std::to_string(*width) + " by " + std::to_string(*height) + " pixels"};
  return Image{*width, *height, 3, {text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size)}};
}

}  // namespace

std::variant<Image, FileProblem> decodeImage(std::span<const std::byte> bytes, const std::string& name) {
  constexpr std::size_t kSignature = 8;
  const bool isPng = bytes.size() >= kSignature &&
                     png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, kSignature) == 0;
  return isPng ? readPng(bytes, name) : readGeneric(bytes, name);
}

std::variant<Image, FileProblem> readImage(const std::string& fileName) {
  auto bytes = readFile(fileName, kLargestFile);
  if (auto* problem = std::get_if<FileProblem>(&bytes)) return std::move(*problem);
  return decodeImage(std::get<Bytes>(bytes), fileName);
}

}  // namespace rayshade
