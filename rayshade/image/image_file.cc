// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/image_file.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <stdexcept>

#include "rayshade/base/file_bytes.h"
#include "rayshade/base/random.h"
#include "rayshade/image/raster_file.h"

namespace rayshade {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 31;

// From levels to the pixels of an image.
class ImageRows final : public RasterRows {
 public:
  ImageRows(SharedBytes& to, std::function<void(std::size_t)> written)
      : to_(to), written_(std::move(written)) {}

  void begin(const RasterSize& size) override {
    size_ = size;
    image.width = size.width;
    image.height = size.height;
    image.channels = size.channels;
    image.place = to_.begin();
    pixels_.resize(size.rowLevels());
    hash_ =
        mixBits(mixBits(static_cast<std::uint64_t>(size.width)) + static_cast<std::uint64_t>(size.height)) +
        static_cast<std::uint64_t>(size.channels) + (size.textureUpsideDown ? 8 : 0);
  }
  void row(std::span<const std::uint16_t> levels) override {
    if (size_.most == 255) {
      std::transform(levels.begin(), levels.end(), pixels_.begin(),
                     [](std::uint16_t level) { return static_cast<std::uint8_t>(level); });
    } else {
      std::transform(levels.begin(), levels.end(), pixels_.begin(), [this](std::uint16_t level) {
        return static_cast<std::uint8_t>((level * 255u + size_.most / 2) / size_.most);
      });
    }
    const std::int32_t row = size_.textureUpsideDown ? row_ : size_.height - 1 - row_;
    ++row_;
    to_.write(image.place.offset + static_cast<std::uint64_t>(row) * pixels_.size(), pixels_);
    addToHash();
    written_(pixels_.size());
  }
  Image finish() {
    image.id = ImageId{mixBits(hash_)};
    image.pixels = mapShared(image.place, image.bytes());
    if (!image.pixels) throw std::runtime_error("cannot map shared memory");
    return std::move(image);
  }

 private:
  void addToHash() {
    std::size_t at = 0;
    for (; at < pixels_.size(); at += sizeof(std::uint64_t)) {
      std::uint64_t some = 0;
      std::memcpy(&some, &pixels_[at], std::min(sizeof some, pixels_.size() - at));
      hash_ = mixBits(hash_ ^ some);
    }
  }

  SharedBytes& to_;
  std::function<void(std::size_t)> written_;  // so many bytes
  Image image;
  RasterSize size_;
  std::int32_t row_ = 0;  // the next one of the file
  std::vector<std::uint8_t> pixels_;
  std::uint64_t hash_ = 0;
};

std::variant<Image, FileProblem> decode(std::span<const std::byte> bytes, const std::string& name,
                                        SharedBytes& to, std::function<void(std::size_t)> written) {
  try {
    ImageRows rows(to, std::move(written));
    readRaster({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name, rows);
    return rows.finish();
  } catch (const std::runtime_error& problem) {
    return FileProblem{problem.what()};
  }
}

}  // namespace

std::variant<Image, FileProblem> decodeImage(std::span<const std::byte> bytes, const std::string& name,
                                             SharedBytes& to) {
  return decode(bytes, name, to, [](std::size_t) {});
}

std::variant<Image, FileProblem> readImage(const std::string& fileName, SharedBytes& to) {
  auto file = FileBytes::open(fileName, kLargestFile);
  if (auto* problem = std::get_if<FileProblem>(&file)) return std::move(*problem);
  FileBytes& content = std::get<FileBytes>(file);
  // What has been read of the file is forgotten now and then.
  constexpr std::size_t kHeld = std::size_t{8} << 20;
  std::size_t written = 0;
  return decode(content.bytes(), fileName, to, [&](std::size_t bytes) {
    written += bytes;
    if (written < kHeld) return;
    written = 0;
    content.forget();
  });
}

}  // namespace rayshade
