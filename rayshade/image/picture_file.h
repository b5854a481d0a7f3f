// Pictures in files.
//
// A file is a function of the linear float pixels and of gamma: levels (PNG, PPM, generic; picture.h), or the linear floats as
// they are (PFM).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "rayshade/image/picture.h"

namespace rayshade {

class CompleteFile;
class PngStream;

enum class PictureFormat : std::uint8_t { generic, ppm, png, png16, pfm };

// The endings of names that say in which format a picture is written.
inline constexpr const char* kPictureEndings = ".png, .ppm, .pfm (linear floats) and .mtv (generic)";
// By the end of the name, in upper or lower case; a name without a dot, and standard output, is generic as in rayshade.
// Nothing: no format is called so.
std::optional<PictureFormat> formatOf(const std::string& fileName);

// Writes a picture row by row, as a whole or not at all (complete_file.h).  PFM goes from the bottom up: its rows wait in
// memory until the last.
// All functions throw std::runtime_error, with the file's name, when the file cannot be written.
class PictureWriter {
 public:
  // Finds out whether the file can be written at all.  An empty name or "-" is standard output.  Without a format the name
  // says it; if it does not, it is generic.
  PictureWriter(const std::string& fileName, std::int32_t width, std::int32_t height, double gamma = 1,
                std::optional<PictureFormat> format = std::nullopt);
  ~PictureWriter();  // an incomplete file goes away
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  void row(std::span<const Color> colors);  // the next one, from the top
  void finish();                            // after the last row

 private:
  void writeLevels(std::span<const Color> colors);

  std::int32_t width_, height_;
  double gamma_;
  PictureFormat format_;
  std::int32_t rows_ = 0;
  Picture waiting_;  // PFM
  std::vector<std::uint8_t> bytes_;
  std::unique_ptr<CompleteFile> output_;
  std::unique_ptr<PngStream> png_;
};

// Reads PFM and what raster_file.h does, told apart by how they begin.  A level n becomes the smallest float
// that is written as n again with gamma 1; gamma and colour spaces are not looked at, transparency is dropped.
// Throws std::runtime_error with the file's name.
Picture readPicture(const std::string& fileName);

}  // namespace rayshade
