// libpng reports errors by longjmp.  Each call of it sits in a function that has no object with a destructor
// between setjmp and the jump; the message is kept and thrown from outside.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/png_file.h"

#include <png.h>

#include <array>
#include <cerrno>
#include <csetjmp>
#include <cstring>

#include "rayshade/image/picture_format.h"

namespace rayshade {
namespace {

// What libpng's error handler leaves behind.
struct PngMessage {
  std::array<char, 200> text{};
};

[[noreturn]] void keepMessage(png_structp png, png_const_charp text) {
  auto* message = static_cast<PngMessage*>(png_get_error_ptr(png));
  std::snprintf(message->text.data(), message->text.size(), "%s", text);
  png_longjmp(png, 1);
}
void dropWarning(png_structp, png_const_charp) {}

// Runs calls of libpng; false: it gave up.
template <class Calls>
bool succeeds(png_structp png, const Calls& calls) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  calls();
  return true;
}

[[noreturn]] void giveUp(const std::string& file, const PngMessage& message) {
  failOn(file, message.text[0] != 0 ? message.text.data() : "no memory for libpng");
}

void writeBytes(png_structp png, png_bytep bytes, std::size_t size) {
  if (!static_cast<CompleteFile*>(png_get_io_ptr(png))->put(bytes, size))
    png_error(png, std::strerror(errno));
}

// What libpng reads from.
struct PngSource {
  std::string_view left;
  static void read(png_structp png, png_bytep to, std::size_t size) {
    auto& left = static_cast<PngSource*>(png_get_io_ptr(png))->left;
    if (size > left.size()) png_error(png, "ends too early");
    std::memcpy(to, left.data(), size);
    left.remove_prefix(size);
  }
};

// A byte of a PNG stands for at most 1032 bytes of pixels (zlib, Maximum Compression Factor), and a byte may hold eight
// pixels, each of which becomes four levels when the palette is looked up.
constexpr std::size_t kMostPerByte = 1032 * 8 * 4;

struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

}  // namespace

struct PngStream::State {
  CompleteFile& output;
  PngMessage message;
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~State() { png_destroy_write_struct(&png, &info); }

  template <class Calls>
  void run(const Calls& calls) {
    if (!succeeds(png, calls)) giveUp(output.name(), message);
  }
};

PngStream::PngStream(CompleteFile& output, std::int32_t width, std::int32_t height, int bits)
    : state_(new State{output, {}}) {
  State& s = *state_;
  s.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &s.message, keepMessage, dropWarning);
  s.info = s.png != nullptr ? png_create_info_struct(s.png) : nullptr;
  if (s.info == nullptr) giveUp(output.name(), s.message);
  s.run([&] {
    png_set_write_fn(s.png, &output, writeBytes, [](png_structp) {});
    png_set_IHDR(s.png, s.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    // Measured on standard scenes: a tenth more bytes than libpng makes by itself, in a third of its time.
    png_set_compression_level(s.png, 1);
    png_set_filter(s.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    png_write_info(s.png, s.info);
  });
}

PngStream::~PngStream() = default;

void PngStream::row(const std::uint8_t* bytes) {
  state_->run([&] { png_write_row(state_->png, bytes); });
}

void PngStream::finish() {
  state_->run([&] { png_write_end(state_->png, state_->info); });
}

void readPng(std::string_view content, const std::string& name, RasterRows& to) {
  PngMessage message;
  PngSource source{content};
  PngReader reader;
  auto run = [&](const auto& calls) {
    if (!succeeds(reader.png, calls)) giveUp(name + ": damaged PNG", message);
  };
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, keepMessage, dropWarning);
  if (reader.png != nullptr) reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) giveUp(name, message);

  int passes = 1;
  run([&] {
    png_set_read_fn(reader.png, &source, PngSource::read);
    png_read_info(reader.png, reader.info);
    png_set_expand(reader.png);  // palettes and fewer than 8 bits to 8, a transparent colour to alpha
    passes = png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
  });
  RasterSize size;
  size.width = static_cast<std::int32_t>(png_get_image_width(reader.png, reader.info));
  size.height = static_cast<std::int32_t>(png_get_image_height(reader.png, reader.info));
  size.channels = png_get_channels(reader.png, reader.info);
  const bool wide = png_get_bit_depth(reader.png, reader.info) == 16;
  size.most = wide ? 65535 : 255;
  countLevels(size, kMostPerByte * content.size(), name);
  to.begin(size);

  // Of an interlaced picture all rows are there, and each pass fills some of their pixels.
  const auto height = static_cast<std::size_t>(size.height), held = passes > 1 ? height : 1;
  const std::size_t length = png_get_rowbytes(reader.png, reader.info);
  std::vector<std::uint8_t> bytes(held * length);
  const auto read = [&](std::size_t row) {
    run([&] { png_read_row(reader.png, &bytes[row % held * length], nullptr); });
  };
  for (int pass = 1; pass < passes; ++pass)
    for (std::size_t row = 0; row < height; ++row) read(row);
  std::vector<std::uint16_t> levels(size.rowLevels());
  for (std::size_t row = 0; row < height; ++row) {
    read(row);
    const std::uint8_t* const from = &bytes[row % held * length];
    for (std::size_t i = 0; i < levels.size(); ++i)
      levels[i] = static_cast<std::uint16_t>(wide ? from[2 * i] << 8 | from[2 * i + 1] : from[i]);
    to.row(levels);
  }
  run([&] { png_read_end(reader.png, nullptr); });
}

}  // namespace rayshade
