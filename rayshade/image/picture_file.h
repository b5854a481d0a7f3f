// Pictures: linear light in memory, files on the way out.
//
// A file is a function of the linear float pixels and of gamma.  Levels (PNG, PPM, generic) are, as in rayshade,
//
//   x' = x^(1/gamma);   below 0 -> 0;   above 1 -> most;   else most * x' without its fraction      most = 255, 65535
//
// and gamma 0 makes all below 1 black.  differs from rayshade4: negative light and what is not a number are
// black whatever the gamma.  PFM holds the linear floats as they are.
// Formats: W3C, Portable Network Graphics, 2003; netpbm, ppm(5); Debevec, Portable Float Map, 2001; "generic"
// is rayshade's `width height` line with RGB bytes after it (mtv).
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rayshade/base/color.h"

namespace rayshade {

struct Picture {
  std::int32_t width = 0, height = 0;
  std::vector<float> pixels;  // red, green, blue; row by row from the top

  friend bool operator==(const Picture&, const Picture&) = default;
};

void appendRow(Picture& picture, std::span<const Color> row);

// Of the size and the bits of the pixels in row order, 64-bit FNV-1a: equal pictures, equal numbers.
std::uint64_t checksum(const Picture& picture);

// The level of linear light, 0..most.
std::uint32_t levelOf(float light, double gamma, std::uint32_t most);

enum class PictureFormat : std::uint8_t { generic, ppm, png, png16, pfm };

// By the end of the name: .png .ppm .pfm; any other, and standard output, is generic as in rayshade.
PictureFormat formatOf(const std::string& fileName);

// Writes a picture row by row.  The rows go to a file beside the final one, which takes the final name when the
// picture is complete: under that name there is never half a picture.  Standard output and what is not a plain
// file (a pipe, a device) is written directly.  PFM goes from the bottom up: its rows wait in memory until the last.
// All functions throw std::runtime_error, with the file's name, when the file cannot be written.
class PictureWriter {
 public:
  // Finds out whether the file can be written at all.  An empty name or "-" is standard output.
  PictureWriter(const std::string& fileName, std::int32_t width, std::int32_t height, double gamma = 1,
                std::optional<PictureFormat> format = std::nullopt);
  ~PictureWriter();  // an incomplete file goes away
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  void row(std::span<const Color> colors);  // the next one, from the top
  void finish();                            // after the last row

 private:
  class Output;
  class PngStream;

  void writeLevels(std::span<const Color> colors);

  std::int32_t width_, height_;
  double gamma_;
  PictureFormat format_;
  std::int32_t rows_ = 0;
  Picture waiting_;  // PFM
  std::vector<std::uint8_t> bytes_;
  std::unique_ptr<Output> output_;
  std::unique_ptr<PngStream> png_;
};

// Reads PNG, PPM (P6), PFM and generic files, told apart by how they begin.  A level n becomes the smallest float
// that is written as n again with gamma 1; gamma and colour spaces are not looked at, transparency is dropped.
// Throws std::runtime_error with the file's name.
Picture readPicture(const std::string& fileName);

}  // namespace rayshade
