// Pictures of textures on their way to the machines.
//
// On the host's own machine a task maps what the host has read; on another one the first task that needs an image gets its pixels
// and the others map those.  The host reads them piece by piece from where they lie and never holds one.  When a task dies its
// copy goes with it: whoever needs the image next on that machine gets it again.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>

#include "pvm/host/roster.h"

namespace rayshade {

class ImageShipping {
 public:
  static constexpr std::size_t kPieceBytes = 32 * 1024;

  // `wait`: takes events in for a while; tasks may die meanwhile.
  ImageShipping(Outbox& outbox, Roster& roster, std::string ownHost, std::function<void()> wait)
      : outbox_(outbox), roster_(roster), ownHost_(std::move(ownHost)), wait_(std::move(wait)) {}

  // What is posted to the task from now on may mention the image.
  void bring(Slave& slave, const Image& image);
  // The same for all images so far: the task gets cells of others.
  void bringAll(Slave& slave);
  // Waits for answers.  False: a task could not reach a copy after all, and must be sent its items, and images, again.
  bool settle();

  // False: nobody has asked for this.
  bool arrive(TaskId from, const ImageTaken& message);

 private:
  struct Held {
    bool answered = false;
    SharedPlace place;  // on the task's machine; after the answer
  };
  struct Holder {
    bool alone = false;  // copies of others are out of its reach
    std::map<ImageId, Held> images;
  };
  const SharedPlace* copyFor(const Slave& slave, const Image& image) const;
  void sendPieces(Slave& slave, const Image& image);
  bool anyOpen();

  Outbox& outbox_;
  Roster& roster_;
  std::string ownHost_;
  std::function<void()> wait_;
  std::map<TaskId, Holder> holders_;
  std::map<ImageId, Image> known_;
  bool failed_ = false;
};

}  // namespace rayshade
