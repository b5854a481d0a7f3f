// The pyramid-trace task (Reinhard & Jansen, section 4, figure 4).
//
// Demand driven: it asks the host for work.  A tile is one pyramid of primary rays; its clip-list says which cells of the
// bin-tree it may touch, near to far, without any object.  The cells up to the horizon are fetched into the object cache -
// while they come, other pyramids are worked on - and then the rays are traced, with all that go on from their hits, as far as
// what is at hand allows.  Rays that need more go over to the data-parallel voxels, or, if objects are to travel and that pays, wait for
// the cell that they miss.
//
// A camera with a lens has no common apex: then the list is the union of the walks of the rays.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/trace/tiles.h"
#include "pvm/trace/trace_unit.h"

namespace rayshade {

class PyramidTask {
 public:
  using Accepted = TypeList<Configure, Finish, Ping, Weights, TileWork, PrimaryRays, CellWanted, CellItems,
                            Answer, ImagePlace, ImagePiece, Observe>;

  explicit PyramidTask(Link& link) : context_(link), unit_(context_, nullptr) {}

  void receive(const LinkEvent& event) { receiveEvent(*this, context_, event); }
  bool work(double until);
  void flush();
  bool finished() const { return context_.finished; }
  // Rays, tiles, and intersections whose shadow rays wait for cells.
  std::uint64_t waiting() const { return rays_.size() + unit_.tiles.size() + unit_.shadows.waiting(); }
  void noteIdle(double seconds) { context_.noteIdle(seconds, waiting()); }

  Report counted() const;  // so far
  std::uint64_t heldBytes() const { return unit_.cache.counts().peakBytes; }

  Epoch epoch() const { return context_.epoch; }
  void on(TaskId from, Configure message);
  void on(TaskId from, Finish);
  void on(TaskId from, Ping);
  void on(TaskId, const Observe& message) { context_.observe(message); }
  void on(TaskId from, Weights message);
  void on(TaskId from, TileWork message);
  void on(TaskId from, PrimaryRays message);
  void on(TaskId from, const Answer& message);
  void on(TaskId, const CellWanted& message) { unit_.giveOn(message); }
  void on(TaskId from, CellItems message);
  void on(TaskId from, const ImagePlace& message) { unit_.images.take(from, message, context_); }
  void on(TaskId from, const ImagePiece& message) { unit_.images.take(from, message, context_); }

 private:
  bool objectsTravel() const { return !unit_.at.policy.secondariesTravel; }
  std::size_t beforeHorizon(std::span<const CellId> cells, std::size_t rays) const;
  bool traceSome();
  void traceWaiting(RayBundle& rays);
  void queue(Ray&& ray, const ReplyTo& to);

  TaskContext context_;
  TraceUnit unit_;
  TaskId host_ = kNobody;
  RayBundle rays_;    // to be traced, last in first out
  RayBundle bundle_;  // being traced
};

}  // namespace rayshade
