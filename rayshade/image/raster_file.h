// Reads the levels of a picture: PNG, JPEG, PPM, PGM, Utah RLE or generic, told apart by their first bytes.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "rayshade/image/raster.h"

namespace rayshade {

// `content`: of the file; `name`: of the file, for messages.  Throws std::runtime_error.
Raster readRaster(std::string_view content, const std::string& name);

}  // namespace rayshade
