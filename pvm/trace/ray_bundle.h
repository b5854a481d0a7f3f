// Rays of a task that wait or are traced together, as a structure of arrays: the unit of tracing.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "pvm/messages/rays.h"

namespace rayshade {

struct RayBundle {
  std::vector<Ray> rays;
  std::vector<double> begin;  // before this t nothing counts that is not local: it has been looked at
  std::vector<ReplyTo> to;    // where the colour goes

  std::size_t size() const { return rays.size(); }
  bool empty() const { return rays.empty(); }
  void clear() { cut(0); }
  void add(Ray&& ray, double from, const ReplyTo& reply) {
    rays.push_back(std::move(ray));
    begin.push_back(from);
    to.push_back(reply);
  }
  // Moves the last `count` rays, in their order, to the end of another bundle.
  void moveLast(std::size_t count, RayBundle& into) {
    for (std::size_t i = size() - count; i < size(); ++i) into.add(std::move(rays[i]), begin[i], to[i]);
    cut(size() - count);
  }

 private:
  void cut(std::size_t size) {
    rays.resize(size);
    begin.resize(size);
    to.resize(size);
  }
};

}  // namespace rayshade
