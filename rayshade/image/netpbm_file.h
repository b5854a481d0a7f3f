// Files with a header in words: PPM and PGM (P2, P3, P5, P6), and PFM.
// Sources: netpbm, ppm(5), pgm(5); Debevec, Portable Float Map, 2001.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "rayshade/image/picture.h"
#include "rayshade/image/raster.h"

namespace rayshade {

// `name`: of the file, for messages.
void readNetpbm(std::string_view content, const std::string& name, RasterRows& to);
Picture readPfm(std::string_view content, const std::string& name);

}  // namespace rayshade
