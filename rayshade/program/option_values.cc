// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/option_values.h"

#include <cstdio>
#include <cstdlib>

#include "rayshade/image/picture_file.h"

namespace rayshade {

CLI::Validator numberFrom(double low, double high) {
  const std::string range = CLI::detail::to_string(low) + " to " + CLI::detail::to_string(high);
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        if (!good) return "`" + text + "` is not a number from " + range;
        char exact[40];
        std::snprintf(exact, sizeof exact, "%a", std::strtod(text.c_str(), nullptr));
        text = exact;
        return std::string();
      },
      range);
}

CLI::Validator notEmpty() {
  return CLI::Validator(
      [](const std::string& text) { return text.empty() ? std::string("an empty name") : std::string(); },
      "");
}

CLI::Validator pictureFile() {
  return CLI::Validator(
      [](const std::string& name) {
        if (formatOf(name)) return std::string();
        return name + ": no format of pictures is called so; there are " + kPictureEndings;
      },
      "");
}

}  // namespace rayshade
