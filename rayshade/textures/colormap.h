// A table of up to 256 colours from a text file: a line `R G B` each, whole numbers 0 .. 255.
//
// Entries that the file does not have are black; lines after the 256th and empty lines are left out.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "rayshade/base/color.h"
#include "rayshade/base/file.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

struct Colormap {
  std::vector<Color> colors;

  // The colour of an entry, cut to a whole number and to 0 .. 255.
  Color at(double entry) const {
    const std::size_t index = !(entry > 0) ? 0 : entry < 255 ? static_cast<std::size_t>(entry) : 255;
    return index < colors.size() ? colors[index] : kBlack;
  }
};

std::variant<Colormap, FileProblem> decodeColormap(std::string_view text, const std::string& name);

// Reads the file that is named next.
Colormap parseColormap(Arguments& in);

template <class Archive>
void serialize(Archive& archive, Colormap& c) {
  archive(c.colors);
}

}  // namespace rayshade
