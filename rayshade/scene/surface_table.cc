// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/surface_table.h"

namespace rayshade {

bool SurfaceTable::define(const std::string& name, const Surface& surface) {
  return named_.insert_or_assign(name, Named{surface, kNoSurface}).second;
}

const Surface* SurfaceTable::find(std::string_view name) const {
  const auto at = named_.find(name);
  return at == named_.end() ? nullptr : &at->second.surface;
}

SurfaceId SurfaceTable::bind(const Surface& surface, SceneSink& sink) {
  const Bytes bytes = encode(surface);
  const std::string key(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto [at, isNew] = numbers_.try_emplace(key, SurfaceId{static_cast<std::uint32_t>(surfaces_.size())});
  if (isNew) {
    surfaces_.push_back(surface);
    sink.surface(at->second, surface);
  }
  return at->second;
}

SurfaceId SurfaceTable::bindName(std::string_view name, SceneSink& sink) {
  Named& named = named_.find(name)->second;
  if (named.id == kNoSurface) named.id = bind(named.surface, sink);
  return named.id;
}

}  // namespace rayshade
