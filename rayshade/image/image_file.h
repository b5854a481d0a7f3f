// Reads pictures for textures.
//
//   generic   a line `width height`, then width * height times the bytes R G B, the row of v = 0 first
//   PNG       gray, RGB or palette, with or without alpha, 1 to 16 bits (16 are rounded to 8), interlaced
//             or not, turned over so that a picture stands upright where v goes up
//
// What a file says of its size is compared with the bytes that are there before memory is taken.
//
// differs from rayshade4: PNG in place of Utah RLE; as there, the lowest row has v = 0.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <variant>

#include "rayshade/base/file.h"
#include "rayshade/image/image.h"

namespace rayshade {

std::variant<Image, FileProblem> readImage(const std::string& fileName);

// The same of the bytes of a file; `name` stands for it in messages.
std::variant<Image, FileProblem> decodeImage(std::span<const std::byte> bytes, const std::string& name);

}  // namespace rayshade
