// A header, then instructions: an opcode, an argument of 8 bits, or of 16 with the low byte first, and data.  They fill the
// channels of one row after another, from the lowest row up.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/rle_file.h"

#include <algorithm>

namespace rayshade {
namespace {

// Of the header.
enum Flag : unsigned { kClearFirst = 1, kNoBackground = 2, kAlpha = 4, kComments = 8 };

enum class Opcode : unsigned { skipLines = 1, setColor, skipPixels, byteData = 5, runData, end };
constexpr unsigned kLong = 0x40;  // in an opcode: the argument has 16 bits
constexpr unsigned kAlphaColor = 255;

// Pixels that are not set take no bytes: so many are believed of any file.  Six bytes may be a run of 65536.
constexpr std::size_t kMostUnset = std::size_t{1} << 22;
constexpr std::size_t kMostPerByte = 65536 / 6 + 1;

class RleReader {
 public:
  RleReader(std::string_view content, const std::string& name) : left_(content), name_(name) {}

  Raster read() {
    readHeader();
    while (instruction()) {
    }
    return std::move(raster_);
  }

 private:
  std::string_view take(std::size_t count) {
    if (count > left_.size()) failOn(name_, "damaged RLE: the file is cut off");
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }
  unsigned byte() { return static_cast<unsigned char>(take(1)[0]); }
  unsigned word() {
    const unsigned low = byte();
    return low | byte() << 8;
  }

  void readHeader() {
    take(2 + 4);  // the magic number, and where the picture lies
    raster_.width = static_cast<std::int32_t>(word());
    raster_.height = static_cast<std::int32_t>(word());
    const unsigned flags = byte();
    colors_ = byte();
    const unsigned bits = byte(), maps = byte(), mapBits = byte();
    if (raster_.width < 1 || raster_.height < 1 || (colors_ != 1 && colors_ != 3) || bits != 8 ||
        mapBits > 16)
      failOn(name_, "an RLE file that is no picture of 8 bits, gray or RGB");
    std::string_view background;
    if ((flags & kNoBackground) == 0) background = take(colors_);
    if (background.size() % 2 == 0) take(1);
    take((std::size_t{maps} << mapBits) * 2);
    if ((flags & kComments) != 0) {
      const std::size_t length = word();
      take(length + length % 2);
    }
    raster_.channels = static_cast<std::int32_t>(colors_) + ((flags & kAlpha) != 0 ? 1 : 0);
    const std::size_t count = countLevels(raster_, kMostUnset + kMostPerByte * left_.size(), name_);
    raster_.levels.resize(count);
    unset_ = count;
    if ((flags & kClearFirst) == 0) return;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t channel = i % static_cast<std::size_t>(raster_.channels);
      if (channel < background.size()) raster_.levels[i] = static_cast<unsigned char>(background[channel]);
    }
  }

  bool instruction() {  // false: it was the last one
    const unsigned code = byte();
    unsigned argument = byte();
    if ((code & kLong) != 0) argument = word();
    switch (static_cast<Opcode>(code & ~kLong)) {
      case Opcode::skipLines:
        row_ += argument;
        return true;
      case Opcode::setColor:
        channel_ = argument == kAlphaColor ? colors_ : argument < colors_ ? argument : kNoChannel;
        x_ = 0;
        return true;
      case Opcode::skipPixels:
        x_ += argument;
        return true;
      case Opcode::byteData: {
        const std::size_t count = argument + std::size_t{1};
        const std::string_view data = take(count + count % 2);
        put(count, [&](std::size_t i) { return data[i]; });
        return true;
      }
      case Opcode::runData: {
        const auto level = static_cast<char>(word() & 0xff);
        put(argument + std::size_t{1}, [&](std::size_t) { return level; });
        return true;
      }
      case Opcode::end:
        return false;
    }
    failOn(name_, "damaged RLE: an unknown instruction " + std::to_string(code));
  }

  // The next pixels of the channel; what is outside of the picture goes nowhere.
  template <class LevelAt>
  void put(std::size_t count, const LevelAt& levelAt) {
    const auto width = static_cast<std::size_t>(raster_.width),
               height = static_cast<std::size_t>(raster_.height);
    const auto channels = static_cast<std::size_t>(raster_.channels);
    const std::size_t first = x_, end = std::min(first + count, width);
    x_ += count;
    if (first >= end || row_ >= height || channel_ >= channels) return;
    // Else a short file could keep us busy for hours.
    if (end - first > unset_) failOn(name_, "damaged RLE: sets pixels again and again");
    unset_ -= end - first;
    std::uint16_t* const row = &raster_.levels[(height - 1 - row_) * width * channels];
    for (std::size_t x = first; x < end; ++x)
      row[x * channels + channel_] = static_cast<unsigned char>(levelAt(x - first));
  }

  static constexpr unsigned kNoChannel = 256;

  std::string_view left_;
  const std::string& name_;
  Raster raster_;
  unsigned colors_ = 0;
  std::size_t row_ = 0, x_ = 0;  // from the lower left
  unsigned channel_ = 0;
  std::size_t unset_ = 0;  // levels
};

}  // namespace

void readRle(std::string_view content, const std::string& name, RasterRows& to) {
  handOn(RleReader(content, name).read(), to);
}

}  // namespace rayshade
