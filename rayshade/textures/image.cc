// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/textures/image.h"

namespace rayshade {
namespace {

using Component = ImageTexture::Component;

struct NamedComponent {
  std::string_view name;
  Component component;
};
constexpr NamedComponent kComponents[] = {
    {"ambient", Component::ambient},
    {"diffuse", Component::diffuse},
    {"specular", Component::specular},
    {"body", Component::body},
    {"reflect", Component::reflect},
    {"reflective", Component::reflect},
    {"transp", Component::transparency},
    {"transparent", Component::transparency},
    {"specpow", Component::specularPower},
    {"index", Component::index},
    {"bump", Component::bump},
};

std::optional<Component> acceptComponent(Arguments& in) {
  for (const NamedComponent& known : kComponents)
    if (in.accept(known.name)) return known.component;
  return std::nullopt;
}

bool takesGrayOnly(Component component) { return component >= Component::reflect; }

struct Pixel {
  Color color;
  double alpha = 1;
};

Pixel pixelAt(const Image& image, std::int32_t x, std::int32_t y) {
  const std::uint8_t* const bytes = image.pixel(x, y);
  auto share = [bytes](int channel) { return bytes[channel] / 255.0; };
  switch (image.channels) {
    case 1:
      return {{share(0), share(0), share(0)}, 1};
    case 2:
      return {{share(0), share(0), share(0)}, share(1)};
    case 3:
      return {{share(0), share(1), share(2)}, 1};
    default:
      return {{share(0), share(1), share(2)}, share(3)};
  }
}

Pixel mix(const Pixel& one, const Pixel& other, double share) {
  return {one.color * (1 - share) + other.color * share, one.alpha * (1 - share) + other.alpha * share};
}

// A place along one side of the picture.
struct Texel {
  std::int32_t number, next;
  double fraction;  // of the way from its corner to the next one's
};

Texel texelAt(double coordinate, std::int32_t size) {
  const double wrapped = coordinate - std::floor(coordinate);
  const double place = wrapped > 0 ? wrapped * size : 0.0;  // NaN: 0
  const std::int32_t number =
      place < size ? static_cast<std::int32_t>(place) : size - 1;  // 1 - tiny rounds to 1
  return {number, number + 1 < size ? number + 1 : 0, place - number};
}

Pixel smoothPixel(const Image& image, const Texel& x, const Texel& y) {
  const Pixel low = mix(pixelAt(image, x.number, y.number), pixelAt(image, x.next, y.number), x.fraction);
  const Pixel high = mix(pixelAt(image, x.number, y.next), pixelAt(image, x.next, y.next), x.fraction);
  return mix(low, high, y.fraction);
}

// Is the picture there?
bool tiled(double u, double v, double tilesU, double tilesV) {
  constexpr double kNone = 0.001;  // fewer tiles than this count as 0
  auto within = [](double x, double tiles) { return x >= 0 && x <= std::abs(tiles); };
  if (tilesU <= -kNone && tilesV <= -kNone) return !(within(u, tilesU) && within(v, tilesV));
  auto allowed = [within](double x, double tiles) {
    return std::abs(tiles) < kNone || within(x, tiles) == (tiles > 0);
  };
  return allowed(u, tilesU) && allowed(v, tilesV);
}

}  // namespace

std::optional<ImageTexture> ImageTexture::parse(Arguments& in) {
  ImageTexture texture;
  texture.image = in.inputImage();
  for (;;) {
    if (in.accept("component")) {
      const auto component = acceptComponent(in);
      if (!component) in.fail("a picture has no such component");
      texture.component = *component;
    } else if (in.accept("range")) {
      texture.high = in.number(kFactor);
      texture.low = in.number(kFactor);
    } else if (in.accept("smooth")) {
      texture.smooth = true;
    } else if (in.accept("textsurf")) {
      texture.base = in.surface();
    } else if (in.accept("tile")) {
      texture.tilesU = in.number();
      texture.tilesV = in.number();
    } else if (in.accept("map")) {
      texture.mapping = parseMapping(in);
    } else {
      break;
    }
  }
  if (takesGrayOnly(texture.component) && texture.image->channels > 2)
    in.fail("this component needs a gray picture");
  return texture;
}

void ImageTexture::apply(TextureHit& hit) const {
  if (!image || !image->pixels || !tiled(hit.u, hit.v, tilesU, tilesV)) return;
  const Texel x = texelAt(hit.u, image->width), y = texelAt(hit.v, image->height);

  if (component == Component::bump) {
    const double here = pixelAt(*image, x.number, y.number).color.r;
    auto slope = [this, here](const Pixel& next) { return low + (high - low) * (next.color.r - here); };
    hit.normal = bendAlongTangents(hit, slope(pixelAt(*image, x.next, y.number)),
                                   slope(pixelAt(*image, x.number, y.next)));
    return;
  }

  const Pixel pixel = smooth ? smoothPixel(*image, x, y) : pixelAt(*image, x.number, y.number);
  constexpr double kInvisible = 0.001, kSolid = 0.999;
  if (pixel.alpha < kInvisible) return;

  const Color factor = Color{low, low, low} + (high - low) * pixel.color;
  Surface changed = base ? *base : hit.surface;
  switch (component) {
    case Component::color:
      scaleAmbientAndDiffuse(changed, pixel.color);
      changed.specular = changed.specular * pixel.color;
      break;
    case Component::ambient:
      changed.ambient = changed.ambient * factor;
      break;
    case Component::diffuse:
      changed.diffuse = changed.diffuse * factor;
      break;
    case Component::specular:
      changed.specular = changed.specular * factor;
      break;
    case Component::body:
      changed.body = changed.body * factor;
      break;
    case Component::reflect:
      changed.reflect *= factor.r;
      break;
    case Component::transparency:
      changed.transparency *= factor.r;
      break;
    case Component::specularPower:
      changed.specularPower *= factor.r;
      break;
    case Component::index:
      changed.index *= factor.r;
      break;
    case Component::bump:
      break;
  }
  hit.surface = pixel.alpha < kSolid ? blend(hit.surface, 1 - pixel.alpha, changed, pixel.alpha) : changed;
}

}  // namespace rayshade
