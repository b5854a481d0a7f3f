// Files with a header in letters and pixels in bytes: PPM (P6), PFM, and rayshade's generic format.
// Sources: netpbm, ppm(5); Debevec, Portable Float Map, 2001; generic is a `width height` line with RGB bytes after it (mtv).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "rayshade/image/picture.h"

namespace rayshade {

// `name`: of the file, for messages.
Picture readPpm(std::string_view content, const std::string& name);
Picture readPfm(std::string_view content, const std::string& name);
Picture readGeneric(std::string_view content, const std::string& name);

}  // namespace rayshade
