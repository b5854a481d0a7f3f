// Facts: pictures that textures show.  They lie once on each machine; a task learns where, or gets the pixels for all others there.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "rayshade/base/type_list.h"
#include "rayshade/image/image.h"

namespace rayshade {

// Host to a tracing task: where the pixels of an image lie on its machine.
struct ImagePlace {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 23;
  Image image;
};
// Host to a tracing task: the next pixels of an image, for its machine.
struct ImagePiece {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 24;
  Image image;
  std::uint64_t offset = 0;
  std::vector<std::uint8_t> bytes;
};
// The answer to both, when the image is whole: can the task reach its pixels?
struct ImageTaken {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 25;
  ImageId image{};
  bool here = false;
  SharedPlace place;  // where on the task's machine
};

template <class Archive>
void serialize(Archive& archive, ImagePlace& m) {
  archive(m.image);
}

template <class Archive>
void serialize(Archive& archive, ImagePiece& m) {
  archive(m.image, m.offset, m.bytes);
}

template <class Archive>
void serialize(Archive& archive, ImageTaken& m) {
  archive(m.image, m.here, m.place);
}

using ImageMessages = TypeList<ImagePlace, ImagePiece, ImageTaken>;

}  // namespace rayshade
