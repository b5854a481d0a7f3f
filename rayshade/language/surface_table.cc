// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/surface_table.h"

namespace rayshade {

bool SurfaceTable::define(const std::string& name, const Surface& surface) {
  return named_.insert_or_assign(name, Named{surface, kNoSurface}).second;
}

const Surface* SurfaceTable::find(std::string_view name) const {
  const auto at = named_.find(name);
  return at == named_.end() ? nullptr : &at->second.surface;
}

BoundSurface SurfaceTable::bind(const Surface& surface, SceneSink& sink) {
  const Bytes bytes = encode(surface);
  const std::string key(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (remembered_.size() >= kRemembered && !remembered_.contains(key)) remembered_.clear();
  const auto [at, isNew] = remembered_.try_emplace(key, SurfaceId{count_});
  if (isNew) {
    ++count_;
    sink.surface(at->second, surface);
  }
  return {at->second, surface};
}

BoundSurface SurfaceTable::bindName(std::string_view name, SceneSink& sink) {
  Named& named = named_.find(name)->second;
  if (named.id == kNoSurface) named.id = bind(named.surface, sink).id;
  return {named.id, named.surface};
}

}  // namespace rayshade
