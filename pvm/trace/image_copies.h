// The pictures that a tracing task can look at: mapped from the one copy on its machine, or taken in for the machine.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>

#include "pvm/messages/task_context.h"

namespace rayshade {

class ImageCopies {
 public:
  // Answers whether the pixels can be reached.  What does not fit is refused and counted.
  void take(TaskId from, const ImagePlace& message, TaskContext& context);
  // A piece that does not follow the one before it is refused; the answer comes after the last one.
  void take(TaskId from, const ImagePiece& message, TaskContext& context);

  // Gives the textures among items their pixels.  False: some are not here.
  bool fill(std::span<Item> items) const;

 private:
  struct Incoming {
    Image image;
    std::uint64_t size = 0;  // so far
  };
  void keep(Image image);

  std::map<ImageId, std::shared_ptr<const Image>> images_;
  std::unique_ptr<SharedBytes> bytes_;  // of those that came in pieces
  std::optional<Incoming> incoming_;
};

}  // namespace rayshade
