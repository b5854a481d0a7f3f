// JPEG files, by libjpeg.  Source: ITU-T T.81, 1992.
//
// Decoded with the integer transform, and colours are not smoothed from pixel to pixel: both are the same in every libjpeg.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "rayshade/image/raster.h"

namespace rayshade {

// Gray or colour.
void readJpeg(std::string_view content, const std::string& name, RasterRows& to);

}  // namespace rayshade
