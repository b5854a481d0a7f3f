// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/image_copies.h"

namespace rayshade {

void ImageCopies::keep(Image image) {
  const ImageId id = image.id;
  images_.insert_or_assign(id, std::make_shared<const Image>(std::move(image)));
}

void ImageCopies::take(TaskId from, const ImagePlace& message, TaskContext& context) {
  Image image = message.image;
  image.pixels = mapShared(image.place, image.bytes());
  const bool here = image.pixels != nullptr;
  context.outbox.post(from, ImageTaken{image.id, here, image.place});
  if (here) keep(std::move(image));
}

void ImageCopies::take(TaskId from, const ImagePiece& message, TaskContext& context) {
  context.outbox.post(from, ItemsTaken{});
  if (message.offset == 0) {
    if (!bytes_) bytes_ = std::make_unique<SharedBytes>();
    incoming_ = Incoming{message.image, 0};
    incoming_->image.place = bytes_->begin();
  }
  if (!incoming_ || incoming_->image.id != message.image.id || !sameSize(incoming_->image, message.image) ||
      message.offset != incoming_->size || message.bytes.empty() ||
      message.bytes.size() > incoming_->image.bytes() - incoming_->size) {
    incoming_.reset();
    ++context.outbox.traffic.refused;
    return;
  }
  bytes_->write(incoming_->image.place.offset + incoming_->size, message.bytes);
  incoming_->size += message.bytes.size();
  if (incoming_->size < incoming_->image.bytes()) return;
  Image image = std::move(incoming_->image);
  incoming_.reset();
  image.pixels = mapShared(image.place, image.bytes());
  const bool here = image.pixels != nullptr;
  context.outbox.post(from, ImageTaken{image.id, here, image.place});
  if (here) keep(std::move(image));
}

bool ImageCopies::fill(std::span<Item> items) const {
  bool all = true;
  for (Item& item : items) {
    NodeItem* const node = std::get_if<NodeItem>(&item);
    if (node == nullptr) continue;
    for (PlacedTexture& placed : node->node.textures) {
      ImageTexture* const texture = std::get_if<ImageTexture>(&placed.texture);
      if (texture == nullptr) continue;
      const auto found = images_.find(texture->image->id);
      if (found != images_.end() && sameSize(*found->second, *texture->image)) {
        texture->image = found->second;
      } else {
        all = false;
      }
    }
  }
  return all;
}

}  // namespace rayshade
