// A picture on a surface.
//
//   image FILE [component NAME] [range high low] [smooth] [textsurf SURFACE] [tile nu nv] [map MAPPING]
//
// Without a component the pixel scales ambient, diffuse and specular; else that component is scaled by
// low + (high - low) pixel.  reflect, transp, specpow, index and bump take gray pictures only; bump takes
// the step to the next pixel for a slope.  Alpha mixes with what was there before.
//
// The picture covers the unit square of (u, v) and repeats: nu > 0 allows it for 0 <= u <= nu only, nu < 0
// forbids it there, 0 allows it everywhere; if nu and nv are below 0 only the rectangle is left out.
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "rayshade/image/image.h"
#include "rayshade/textures/mapping.h"
#include "rayshade/textures/texture.h"

namespace rayshade {

struct ImageTexture {
  enum class Component : std::uint8_t {
    color,
    ambient,
    diffuse,
    specular,
    body,
    reflect,
    transparency,
    specularPower,
    index,
    bump
  } component = Component::color;
  double high = 1, low = 0;
  bool smooth = false;  // interpolate between a pixel and the next ones, from its corner
  std::optional<Surface>
      base;  // `textsurf`: what the picture is applied to, in place of the surface of the hit
  double tilesU = 0, tilesV = 0;
  Mapping mapping;
  std::shared_ptr<const Image> image;  // shared by copies; after decode without pixels

  static constexpr std::string_view keyword = "image";
  static constexpr TextureNeeds needs = TextureNeeds::coordinates;
  static constexpr bool makesTransparent = false;
  static constexpr std::string_view examples[] = {
      "picture.png", "picture.png smooth tile 2 -1 component body range 1 .1 map planar 0 0 0  0 0 1  1 0 0"};

  static std::optional<ImageTexture> parse(Arguments& in);
  const Surface* otherSurface() const { return base ? &*base : nullptr; }
  void apply(TextureHit& hit) const;
};

template <class Archive>
void serialize(Archive& archive, ImageTexture& t) {
  archive(t.component, t.high, t.low, t.smooth, t.base, t.tilesU, t.tilesV, t.mapping);
  if constexpr (Archive::kReading) {
    Image image;
    archive(image);
    t.image = std::make_shared<const Image>(std::move(image));
    if (t.component > ImageTexture::Component::bump) archive.fail();
  } else {
    archive(t.image ? *t.image : Image{});
  }
}

}  // namespace rayshade
