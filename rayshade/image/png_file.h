// PNG files, by libpng.  Source: W3C, Portable Network Graphics, 2003.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string_view>

#include "rayshade/image/complete_file.h"
#include "rayshade/image/raster.h"

namespace rayshade {

// Writes rows of RGB with 8 bits, or 16 with the high byte first.
class PngStream {
 public:
  PngStream(CompleteFile& output, std::int32_t width, std::int32_t height, int bits);
  ~PngStream();
  PngStream(const PngStream&) = delete;
  PngStream& operator=(const PngStream&) = delete;

  void row(const std::uint8_t* bytes);
  void finish();

 private:
  struct State;  // libpng's
  std::unique_ptr<State> state_;
};

// `name`: of the file, for messages.
void readPng(std::string_view content, const std::string& name, RasterRows& to);

}  // namespace rayshade
