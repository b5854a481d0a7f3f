// Reads the levels of a picture: PNG, JPEG, PPM, PGM, Utah RLE or generic, told apart by their first bytes.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "rayshade/image/raster.h"

namespace rayshade {

// `content`: of the file; `name`: of the file, for messages.  Throws std::runtime_error.  Row by row: nothing is held but a row,
// except of interlaced PNG, progressive JPEG and RLE, whose rows are complete at the end only.
void readRaster(std::string_view content, const std::string& name, RasterRows& to);

// The whole in memory.
Raster readRaster(std::string_view content, const std::string& name);

}  // namespace rayshade
