// Run-length encoded files of the Utah Raster Toolkit, which rayshade writes and reads.
// Source: S. Thomas, Design of the Utah RLE Format, University of Utah, 1986.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "rayshade/image/raster.h"

namespace rayshade {

// One or three channels, with or without alpha.  Colour maps are passed over and pixels that are not set have the background
// where the file says so, else 0, as in rayshade.
void readRle(std::string_view content, const std::string& name, RasterRows& to);

}  // namespace rayshade
