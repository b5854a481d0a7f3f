// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/raster_file.h"

#include "rayshade/image/generic_file.h"
#include "rayshade/image/jpeg_file.h"
#include "rayshade/image/netpbm_file.h"
#include "rayshade/image/png_file.h"
#include "rayshade/image/rle_file.h"

namespace rayshade {
namespace {

struct Format {
  std::string_view begin;
  void (*read)(std::string_view content, const std::string& name, RasterRows& to);
};
constexpr Format kFormats[] = {
    {"\x89PNG", readPng}, {"\xff\xd8", readJpeg}, {"\x52\xcc", readRle}, {"P2", readNetpbm},
    {"P3", readNetpbm},   {"P5", readNetpbm},     {"P6", readNetpbm},
};

class WholeRaster final : public RasterRows {
 public:
  void begin(const RasterSize& size) override {
    static_cast<RasterSize&>(raster) = size;
    raster.levels.reserve(size.rowLevels() * static_cast<std::size_t>(size.height));
  }
  void row(std::span<const std::uint16_t> levels) override {
    raster.levels.insert(raster.levels.end(), levels.begin(), levels.end());
  }
  Raster raster;
};

}  // namespace

void readRaster(std::string_view content, const std::string& name, RasterRows& to) {
  for (const Format& format : kFormats)
    if (content.starts_with(format.begin)) return format.read(content, name, to);
  readGeneric(content, name, to);
}

Raster readRaster(std::string_view content, const std::string& name) {
  WholeRaster whole;
  readRaster(content, name, whole);
  return std::move(whole.raster);
}

}  // namespace rayshade
