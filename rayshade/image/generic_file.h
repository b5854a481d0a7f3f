// Rayshade's generic format, or mtv: a line `width height`, then the bytes R G B of each pixel.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "rayshade/image/raster.h"

namespace rayshade {

void readGeneric(std::string_view content, const std::string& name, RasterRows& to);

}  // namespace rayshade
