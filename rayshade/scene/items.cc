// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/scene/items.h"

#include "rayshade/base/archive.h"

namespace rayshade {
namespace {

template <class Archive>
void serializeFrame(Archive& archive, SceneNode& f) {
  archive(f.parent, f.transforms, f.surface, f.textures);
}
template <class Archive>
void serializeObject(Archive& archive, SceneObject& o) {
  archive(o.id, o.container, o.node, o.surface, o.body);
}

}  // namespace

template <class Archive>
void serialize(Archive& archive, PlacedTexture& t) {
  archive(t.texture, t.transforms);
}

void serialize(Writer& archive, SceneNode& f) { serializeFrame(archive, f); }
void serialize(Reader& archive, SceneNode& f) { serializeFrame(archive, f); }
void serialize(Writer& archive, SceneObject& o) { serializeObject(archive, o); }
void serialize(Reader& archive, SceneObject& o) { serializeObject(archive, o); }

}  // namespace rayshade
