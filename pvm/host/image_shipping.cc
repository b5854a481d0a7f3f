// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/image_shipping.h"

#include <algorithm>

#include "pvm/host/shipping.h"

namespace rayshade {

// A copy on the machine of the task; null: there is none.
const SharedPlace* ImageShipping::copyFor(const Slave& slave, const Image& image) const {
  const auto own = holders_.find(slave.task);
  if (own != holders_.end() && own->second.alone) return nullptr;
  if (slave.placement.host == ownHost_) return &image.place;
  for (const Slave& other : roster_.slaves()) {
    if (other.task == kNobody || other.task == slave.task || other.placement.host != slave.placement.host)
      continue;
    const auto holder = holders_.find(other.task);
    if (holder == holders_.end()) continue;
    const auto held = holder->second.images.find(image.id);
    if (held != holder->second.images.end() && held->second.answered) return &held->second.place;
  }
  return nullptr;
}

void ImageShipping::bring(Slave& slave, const Image& image) {
  known_.insert_or_assign(image.id, image);
  if (slave.task == kNobody) return;
  Holder& holder = holders_[slave.task];
  if (!holder.images.try_emplace(image.id).second) return;
  if (const SharedPlace* place = copyFor(slave, image)) {
    Image there = image;
    there.place = *place;
    outbox_.post(slave.task, ImagePlace{there});
  } else {
    sendPieces(slave, image);
  }
}

void ImageShipping::sendPieces(Slave& slave, const Image& image) {
  const TaskId task = slave.task;
  ImagePiece piece{image, 0, {}};
  for (; piece.offset < image.bytes(); piece.offset += piece.bytes.size()) {
    piece.bytes.resize(std::min<std::uint64_t>(kPieceBytes, image.bytes() - piece.offset));
    SharedPlace place = image.place;
    place.offset += piece.offset;
    readShared(place, piece.bytes);
    while (slave.task == task && slave.batchesOut >= Shipping::kBatches) wait_();
    if (slave.task != task) return;  // its successor asks again
    ++slave.batchesOut;
    outbox_.post(task, piece);
  }
  // Others on its machine may need it next.
  while (slave.task == task && !holders_[task].images[image.id].answered && !failed_) wait_();
}

void ImageShipping::bringAll(Slave& slave) {
  const std::map<ImageId, Image> known = known_;
  for (const auto& [id, image] : known) bring(slave, image);
}

bool ImageShipping::anyOpen() {
  return std::ranges::any_of(roster_.slaves(), [this](const Slave& slave) {
    const auto holder = holders_.find(slave.task);
    return slave.task != kNobody && holder != holders_.end() &&
           std::ranges::any_of(holder->second.images,
                               [](const auto& entry) { return !entry.second.answered; });
  });
}

bool ImageShipping::settle() {
  while (!failed_ && anyOpen()) wait_();
  return !std::exchange(failed_, false);
}

bool ImageShipping::arrive(TaskId from, const ImageTaken& message) {
  const auto holder = holders_.find(from);
  if (holder == holders_.end()) return false;
  const auto held = holder->second.images.find(message.image);
  if (held == holder->second.images.end() || held->second.answered) return false;
  if (message.here) {
    held->second = {true, message.place};
    return true;
  }
  holder->second.images.erase(held);
  holder->second.alone = true;
  if (Slave* slave = roster_.find(from)) slave->hasItems = false;
  failed_ = true;
  return true;
}

}  // namespace rayshade
