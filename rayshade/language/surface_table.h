// The surfaces of a scene: what their names mean, and their numbers.
//
// A surface gets a number when an object is bound to it for the first time.  Equal surfaces have one number, whatever
// their names, as long as the table remembers them: what has no name is forgotten after kRemembered others, so that a
// scene may give each of any number of objects a surface of its own.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "rayshade/language/expression_reader.h"
#include "rayshade/scene/items.h"

namespace rayshade {

// A surface and its number, if an object is bound to it.
struct BoundSurface {
  SurfaceId id = kNoSurface;
  Surface surface = defaultSurface();
};

class SurfaceTable {
 public:
  static constexpr std::size_t kRemembered = 4096;

  // false when the name had a meaning already; the new one holds from now on.
  bool define(const std::string& name, const Surface& surface);
  bool known(std::string_view name) const { return named_.find(name) != named_.end(); }
  const Surface* find(std::string_view name) const;

  // The number of a surface; the sink hears of it when it is new.
  BoundSurface bind(const Surface& surface, SceneSink& sink);
  BoundSurface bindName(std::string_view name, SceneSink& sink);  // of a known name

 private:
  struct Named {
    Surface surface;
    SurfaceId id = kNoSurface;
  };
  NameMap<Named> named_;
  NameMap<SurfaceId> remembered_;  // by the bytes of the surface
  std::uint32_t count_ = 0;
};

}  // namespace rayshade
