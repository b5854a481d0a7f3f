// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/image_library.h"

#include <sys/stat.h>

#include "rayshade/image/image_file.h"

namespace rayshade {

std::variant<std::shared_ptr<const Image>, FileProblem> ImageLibrary::read(const std::string& fileName) {
  struct stat status {};
  if (stat(fileName.c_str(), &status) != 0) status = {};
  const std::int64_t changed = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
  const auto size = static_cast<std::uint64_t>(status.st_size);
  Entry& entry = entries_[fileName];
  if (entry.image && entry.changed == changed && entry.size == size) return entry.image;
  if (!bytes_) bytes_ = std::make_unique<SharedBytes>();
  auto read = readImage(fileName, *bytes_);
  if (auto* problem = std::get_if<FileProblem>(&read)) return std::move(*problem);
  entry = {changed, size, std::make_shared<const Image>(std::get<Image>(std::move(read)))};
  return entry.image;
}

}  // namespace rayshade
