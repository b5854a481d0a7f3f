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
  Raster (*read)(std::string_view content, const std::string& name);
};
constexpr Format kFormats[] = {
    {"\x89PNG", readPng}, {"\xff\xd8", readJpeg}, {"\x52\xcc", readRle}, {"P2", readNetpbm},
    {"P3", readNetpbm},   {"P5", readNetpbm},     {"P6", readNetpbm},
};

}  // namespace

Raster readRaster(std::string_view content, const std::string& name) {
  for (const Format& format : kFormats)
    if (content.starts_with(format.begin)) return format.read(content, name);
  return readGeneric(content, name);
}

}  // namespace rayshade
