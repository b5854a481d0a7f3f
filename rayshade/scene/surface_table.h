// The surfaces of a scene: what their names mean, and their numbers.
//
// A surface gets a number when an object is bound to it for the first time; equal surfaces have one number,
// however often and under whatever names they are used.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rayshade/scene/expression.h"
#include "rayshade/scene/items.h"

namespace rayshade {

class SurfaceTable {
 public:
  // false when the name had a meaning already; the new one holds from now on.
  bool define(const std::string& name, const Surface& surface);
  bool known(std::string_view name) const { return named_.find(name) != named_.end(); }
  const Surface* find(std::string_view name) const;

  // The number of a surface; the sink hears of it when it is new.
  SurfaceId bind(const Surface& surface, SceneSink& sink);
  SurfaceId bindName(std::string_view name, SceneSink& sink);  // of a known name
  const Surface& at(SurfaceId id) const { return surfaces_[number(id)]; }

 private:
  struct Named {
    Surface surface;
    SurfaceId id = kNoSurface;
  };
  NameMap<Named> named_;
  std::vector<Surface> surfaces_;  // by number
  NameMap<SurfaceId> numbers_;     // by the bytes of the surface
};

}  // namespace rayshade
