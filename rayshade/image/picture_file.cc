// Pictures in files; what is promised is in picture.h.
//
// libpng reports errors by longjmp.  Each call of it sits in a function that has no object with a destructor
// between setjmp and the jump; the message is kept and thrown from outside.
//
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/picture_file.h"

#include <fcntl.h>
#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace rayshade {
namespace {

[[noreturn]] void fail(const std::string& file, const std::string& why) {
  throw std::runtime_error(file + ": " + why);
}

std::uint32_t mostOf(PictureFormat format) { return format == PictureFormat::png16 ? 65535 : 255; }

constexpr std::int32_t kMaxSide = 1'000'000;  // pixels; libpng's own limit

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

}  // namespace

void appendRow(Picture& picture, std::span<const Color> row) {
  for (const Color& c : row)
    for (double light : {c.r, c.g, c.b}) picture.pixels.push_back(static_cast<float>(light));
}

std::uint64_t checksum(const Picture& picture) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  auto add = [&hash](std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 0xff)) * 0x100000001b3u;
  };
  add(static_cast<std::uint32_t>(picture.width));
  add(static_cast<std::uint32_t>(picture.height));
  for (float light : picture.pixels) add(std::bit_cast<std::uint32_t>(light));
  return hash;
}

std::uint32_t levelOf(float light, double gamma, std::uint32_t most) {
  if (!(light >= 0)) return 0;
  const double shown = gamma == 1 ? light : std::pow(static_cast<double>(light), 1 / gamma);
  if (shown > 1) return most;
  return shown > 0 ? static_cast<std::uint32_t>(most * shown) : 0;
}

PictureFormat formatOf(const std::string& fileName) {
  if (fileName.ends_with(".png")) return PictureFormat::png;
  if (fileName.ends_with(".ppm")) return PictureFormat::ppm;
  if (fileName.ends_with(".pfm")) return PictureFormat::pfm;
  return PictureFormat::generic;
}

// The open file: a temporary one that takes its final name by commit(), or one that is written directly.
class PictureWriter::Output {
 public:
  explicit Output(const std::string& fileName) : name_(fileName) {
    if (name_.empty() || name_ == "-") {
      name_ = "standard output";
      file_ = stdout;
      return;
    }
    std::error_code error;
    const auto status = std::filesystem::status(name_, error);
    if (std::filesystem::is_directory(status)) fail(name_, "is a directory");
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
      open(name_, O_WRONLY);
      return;
    }
    final_ = name_;
    if (std::filesystem::exists(status)) {
      if (access(name_.c_str(), W_OK) != 0) fail(name_, std::strerror(errno));
      final_ = std::filesystem::canonical(name_, error).string();  // a link stays a link
      if (error) fail(name_, error.message());
    }
    const std::string beside = final_ + ".part-" + std::to_string(getpid());
    for (int attempt = 0; file_ == nullptr; ++attempt) {
      const std::string candidate = beside + "-" + std::to_string(attempt);
      const bool last = attempt == 99;
      if (open(candidate, O_WRONLY | O_CREAT | O_EXCL, !last)) temporary_ = candidate;
    }
  }
  ~Output() {
    if (file_ != nullptr && file_ != stdout) std::fclose(file_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  const std::string& name() const { return name_; }

  bool put(const void* bytes, std::size_t size) { return std::fwrite(bytes, 1, size, file_) == size; }
  void write(const void* bytes, std::size_t size) {
    if (!put(bytes, size)) fail(name_, std::strerror(errno));
  }
  void write(std::string_view text) { write(text.data(), text.size()); }

  void commit() {
    bool good = std::fflush(file_) == 0;
    if (file_ != stdout) good = (std::fclose(std::exchange(file_, nullptr)) == 0) && good;
    if (!good) fail(name_, std::strerror(errno));
    if (temporary_.empty()) return;
    if (std::rename(temporary_.c_str(), final_.c_str()) != 0) fail(name_, std::strerror(errno));
    temporary_.clear();
  }

 private:
  // False only when the file exists, must not, and `another` name can be tried.
  bool open(const std::string& path, int flags, bool another = false) {
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST && another) return false;
    if (descriptor < 0) fail(name_, std::strerror(errno));
    file_ = fdopen(descriptor, "wb");
    if (file_ == nullptr) {
      close(descriptor);
      fail(name_, std::strerror(errno));
    }
    return true;
  }

  std::string name_, final_, temporary_;
  std::FILE* file_ = nullptr;
};

class PictureWriter::PngStream {
 public:
  PngStream(Output& output, std::int32_t width, std::int32_t height, int bits) : output_(output) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message_, keepMessage, dropWarning);
    info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
    const bool good =
        info_ != nullptr && succeeds(png_, [&] {
          png_set_write_fn(png_, &output_, write, [](png_structp) {});
          png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
                       PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                       PNG_FILTER_TYPE_DEFAULT);
          png_write_info(png_, info_);
        });
    if (!good) {
      png_destroy_write_struct(&png_, &info_);
      giveUp();
    }
  }
  ~PngStream() { png_destroy_write_struct(&png_, &info_); }
  PngStream(const PngStream&) = delete;
  PngStream& operator=(const PngStream&) = delete;

  void row(const std::uint8_t* bytes) {
    if (!succeeds(png_, [&] { png_write_row(png_, bytes); })) giveUp();
  }
  void finish() {
    if (!succeeds(png_, [&] { png_write_end(png_, info_); })) giveUp();
  }

 private:
  static void write(png_structp png, png_bytep bytes, std::size_t size) {
    if (!static_cast<Output*>(png_get_io_ptr(png))->put(bytes, size)) png_error(png, std::strerror(errno));
  }
  [[noreturn]] void giveUp() {
    fail(output_.name(), message_.text[0] != 0 ? message_.text.data() : "no memory for libpng");
  }

  Output& output_;
  PngMessage message_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

PictureWriter::PictureWriter(const std::string& fileName, std::int32_t width, std::int32_t height,
                             double gamma, std::optional<PictureFormat> format)
    : width_(width), height_(height), gamma_(gamma), format_(format.value_or(formatOf(fileName))) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    fail(fileName,
         "a picture cannot have " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  waiting_ = {width, height, {}};
  output_ = std::make_unique<Output>(fileName);
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
  if (!file) fail(name, std::strerror(errno));
  std::string content;
  std::array<char, 1 << 16> block;
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get()))
    content.append(block.data(), n);
  if (std::ferror(file.get()) != 0) fail(name, std::strerror(errno));
  return content;
}

// The smallest float that levelOf() turns into this level.
float lightOf(std::uint32_t level, std::uint32_t most) {
  const float light = static_cast<float>(static_cast<double>(level) / most);
  return levelOf(light, 1, most) == level ? light : std::nextafter(light, 2.0f);
}

// The bytes of a file from front to back.
class Cursor {
 public:
  Cursor(std::string_view left, const std::string& name) : left_(left), name_(name) {}

  std::string_view word() {  // netpbm: words between blanks and comments
    for (;;) {
      const std::size_t begin = left_.find_first_not_of(kBlanks);
      if (begin == left_.npos) fail(name_, "ends in its header");
      left_.remove_prefix(begin);
      if (left_[0] != '#') break;
      left_.remove_prefix(std::min(left_.find('\n'), left_.size()));
    }
    const std::size_t end = std::min(left_.find_first_of(kBlanks), left_.size());
    const std::string_view result = left_.substr(0, end);
    left_.remove_prefix(end);
    return result;
  }
  std::int32_t number(std::int32_t most) {
    const std::string_view text = word();
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < 1 || value > most)
      fail(name_, "bad number in its header");
    return value;
  }
  std::string_view afterBlank() const {  // one blank ends the header
    return left_.empty() ? left_ : left_.substr(1);
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r\n\v\f";
  std::string_view left_;
  const std::string& name_;
};

// The number of values in a picture; fails unless the file has as many bytes.
std::size_t countValues(const Picture& picture, std::size_t bytesPerValue, std::size_t bytes,
                        const std::string& name) {
  const std::size_t count =
      std::size_t{3} * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  if (bytes / bytesPerValue < count) fail(name, "ends too early");
  return count;
}

Picture readLevels(Cursor header, std::optional<std::uint32_t> most, const std::string& name) {
  Picture picture;
  picture.width = header.number(kMaxSide);
  picture.height = header.number(kMaxSide);
  if (!most) most = static_cast<std::uint32_t>(header.number(65535));
  const std::string_view bytes = header.afterBlank();
  const std::size_t size = *most > 255 ? 2 : 1;
  const std::size_t count = countValues(picture, size, bytes.size(), name);
  picture.pixels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t level = 0;
    for (char byte : bytes.substr(i * size, size)) level = level << 8 | static_cast<std::uint8_t>(byte);
    picture.pixels.push_back(lightOf(std::min(level, *most), *most));
  }
  return picture;
}

Picture readPfm(Cursor header, const std::string& name) {
  Picture picture;
  picture.width = header.number(kMaxSide);
  picture.height = header.number(kMaxSide);
  const bool bigEndian = !header.word().starts_with('-');
  const std::string_view bytes = header.afterBlank();
  picture.pixels.resize(countValues(picture, sizeof(float), bytes.size(), name));
  const std::size_t length = static_cast<std::size_t>(picture.width) * 3;
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    std::array<char, sizeof(float)> value;
    std::memcpy(value.data(), &bytes[i * sizeof(float)], sizeof(float));
    if (bigEndian) std::ranges::reverse(value);
    const std::size_t row = static_cast<std::size_t>(picture.height) - 1 - i / length;  // from the bottom
    picture.pixels[row * length + i % length] = std::bit_cast<float>(value);
  }
  return picture;
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

struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

Picture readPng(std::string_view content, const std::string& name) {
  PngMessage message;
  PngSource source{content};
  PngReader reader;
  auto check = [&](bool good) {
    if (!good) fail(name, message.text[0] != 0 ? message.text.data() : "no memory for libpng");
  };
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, keepMessage, dropWarning);
  check(reader.png != nullptr);
  reader.info = png_create_info_struct(reader.png);
  check(reader.info != nullptr);

  check(succeeds(reader.png, [&] {
    png_set_read_fn(reader.png, &source, PngSource::read);
    png_read_info(reader.png, reader.info);
    png_set_expand(reader.png);
    png_set_gray_to_rgb(reader.png);
    png_set_strip_alpha(reader.png);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
  }));
  Picture picture;
  picture.width = static_cast<std::int32_t>(png_get_image_width(reader.png, reader.info));
  picture.height = static_cast<std::int32_t>(png_get_image_height(reader.png, reader.info));
  // A byte of a PNG stands for at most 1032 bytes of pixels (zlib, Maximum Compression Factor), and a pixel of
  // the file has at least one bit: what it claims is believed only if it can be there.
  constexpr std::size_t kMostPerByte = 1032 * 8;
  const std::size_t values = countValues(picture, 1, content.size() * kMostPerByte * 3, name);

  const std::size_t size = png_get_bit_depth(reader.png, reader.info) == 16 ? 2 : 1;
  std::vector<png_byte> bytes(values * size);
  std::vector<png_bytep> rows;
  const std::size_t length = bytes.size() / static_cast<std::size_t>(picture.height);
  for (std::size_t at = 0; at < bytes.size(); at += length) rows.push_back(&bytes[at]);
  check(png_get_rowbytes(reader.png, reader.info) == length);
  check(succeeds(reader.png, [&] { png_read_image(reader.png, rows.data()); }));

  const std::uint32_t most = size == 2 ? 65535 : 255;
  picture.pixels.reserve(values);
  for (std::size_t i = 0; i < bytes.size(); i += size)
    picture.pixels.push_back(lightOf(size == 2 ? bytes[i] * 256u + bytes[i + 1] : bytes[i], most));
  return picture;
}

}  // namespace

Picture readPicture(const std::string& fileName) {
  const std::string content = readFile(fileName);
  if (content.starts_with("\x89PNG")) return readPng(content, fileName);
  Cursor cursor(content, fileName);
  if (content.starts_with("P6")) return cursor.word(), readLevels(cursor, std::nullopt, fileName);
  if (content.starts_with("PF")) return cursor.word(), readPfm(cursor, fileName);
  if (!content.empty() && content[0] >= '0' && content[0] <= '9') return readLevels(cursor, 255, fileName);
  fail(fileName, "is not a PNG, PPM (P6), PFM (PF) or generic picture");
}

}  // namespace rayshade
