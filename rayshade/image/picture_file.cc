// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/picture_file.h"

#include <array>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "rayshade/image/complete_file.h"
#include "rayshade/image/netpbm_file.h"
#include "rayshade/image/picture_format.h"
#include "rayshade/image/png_file.h"
#include "rayshade/image/raster_file.h"

namespace rayshade {
namespace {

std::uint32_t mostOf(PictureFormat format) { return format == PictureFormat::png16 ? 65535 : 255; }

}  // namespace

std::optional<PictureFormat> formatOf(const std::string& fileName) {
  std::string ending = fileName.substr(fileName.find_last_of('/') + 1);
  ending.erase(0, ending.find_last_of('.'));
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".png") return PictureFormat::png;
  if (ending == ".ppm") return PictureFormat::ppm;
  if (ending == ".pfm") return PictureFormat::pfm;
  if (ending == ".mtv" || !ending.starts_with('.')) return PictureFormat::generic;
  return std::nullopt;
}

PictureWriter::PictureWriter(const std::string& fileName, std::int32_t width, std::int32_t height,
                             double gamma, std::optional<PictureFormat> format)
    : width_(width),
      height_(height),
      gamma_(gamma),
      format_(format ? *format : formatOf(fileName).value_or(PictureFormat::generic)) {
  if (width < 1 || height < 1 || width > kLongestSide || height > kLongestSide)
    failOn(fileName,
           "a picture cannot have " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  waiting_ = {width, height, {}};
  output_ = std::make_unique<CompleteFile>(fileName);
  const std::string size = std::to_string(width) + " " + std::to_string(height) + "\n";
  switch (format_) {
    case PictureFormat::generic:
      output_->write(size);
      break;
    case PictureFormat::ppm:
      output_->write("P6\n" + size + "255\n");
      break;
    case PictureFormat::pfm:
      output_->write("PF\n" + size + "-1.0\n");  // negative: little-endian
      break;
    case PictureFormat::png:
    case PictureFormat::png16:
      png_ = std::make_unique<PngStream>(*output_, width, height, format_ == PictureFormat::png ? 8 : 16);
      break;
  }
}

PictureWriter::~PictureWriter() = default;

void PictureWriter::row(std::span<const Color> colors) {
  if (colors.size() != static_cast<std::size_t>(width_) || rows_ == height_)
    throw std::logic_error("PictureWriter: a row too many or of the wrong length");
  ++rows_;
  if (format_ == PictureFormat::pfm)
    appendRow(waiting_, colors);
  else
    writeLevels(colors);
}

void PictureWriter::writeLevels(std::span<const Color> colors) {
  const std::uint32_t most = mostOf(format_);
  bytes_.resize(colors.size() * 3 * (most > 255 ? 2 : 1));
  std::uint8_t* to = bytes_.data();
  for (const Color& c : colors) {
    for (double light : {c.r, c.g, c.b}) {
      const std::uint32_t level = levelOf(static_cast<float>(light), gamma_, most);
      if (most > 255) *to++ = static_cast<std::uint8_t>(level >> 8);  // PNG is big-endian
      *to++ = static_cast<std::uint8_t>(level & 0xff);
    }
  }
  if (png_)
    png_->row(bytes_.data());
  else
    output_->write(bytes_.data(), bytes_.size());
}

void PictureWriter::finish() {
  if (rows_ != height_ || !output_) throw std::logic_error("PictureWriter: finished too early or twice");
  if (format_ == PictureFormat::pfm) {
    static_assert(std::endian::native == std::endian::little, "PFM is written as it lies in memory");
    const std::size_t length = static_cast<std::size_t>(width_) * 3;
    for (std::size_t at = waiting_.pixels.size(); at != 0; at -= length)
      output_->write(&waiting_.pixels[at - length], length * sizeof(float));
  }
  if (png_) png_->finish();
  png_.reset();
  output_->commit();
  output_.reset();
}

namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string readFile(const std::string& name) {
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(name.c_str(), "rb"));
  if (!file) failOn(name, std::strerror(errno));
  std::string content;
  std::array<char, 1 << 16> block;
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get()))
    content.append(block.data(), n);
  if (std::ferror(file.get()) != 0) failOn(name, std::strerror(errno));
  return content;
}

Picture pictureOf(const Raster& raster) {
  Picture picture{raster.width, raster.height, {}};
  const auto channels = static_cast<std::size_t>(raster.channels);
  picture.pixels.reserve(raster.levels.size() / channels * 3);
  for (std::size_t at = 0; at < raster.levels.size(); at += channels)
    for (std::size_t color = 0; color < 3; ++color)
      picture.pixels.push_back(lightOf(raster.levels[channels > 2 ? at + color : at], raster.most));
  return picture;
}

}  // namespace

Picture readPicture(const std::string& fileName) {
  const std::string content = readFile(fileName);
  return content.starts_with("PF") ? readPfm(content, fileName) : pictureOf(readRaster(content, fileName));
}

}  // namespace rayshade
