// The pictures that a scene names, each read once, however many textures use it and however often the scene is read.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "rayshade/base/file.h"
#include "rayshade/image/image.h"

namespace rayshade {

class ImageLibrary {
 public:
  // A file that has changed since is read again.
  std::variant<std::shared_ptr<const Image>, FileProblem> read(const std::string& fileName);

 private:
  struct Entry {
    std::int64_t changed = 0;  // nanoseconds
    std::uint64_t size = 0;
    std::shared_ptr<const Image> image;
  };
  std::unique_ptr<SharedBytes> bytes_;  // once there is an image
  std::map<std::string, Entry> entries_;
};

}  // namespace rayshade
