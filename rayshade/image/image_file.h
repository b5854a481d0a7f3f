// Reads pictures for textures, of every format of raster_file.h.
//
// They have 8 bits and stand upright where v goes up; the first row of generic files has v = 0.
//
// differs from rayshade4: that reads generic files, or, as it was built, Utah RLE.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <variant>

#include "rayshade/base/file.h"
#include "rayshade/image/image.h"

namespace rayshade {

// Row by row: the pixels go to `to`, and neither they nor the file are held.
std::variant<Image, FileProblem> readImage(const std::string& fileName, SharedBytes& to);

// The same of the bytes of a file; `name` stands for it in messages.
std::variant<Image, FileProblem> decodeImage(std::span<const std::byte> bytes, const std::string& name,
                                             SharedBytes& to);

}  // namespace rayshade
