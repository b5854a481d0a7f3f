#include "scenes/spd/rayshade_writer.h"

#include <algorithm>
#include <cmath>

#include "rayshade/base/elementary.h"

namespace rayshade::spd {

namespace {
std::uint32_t number(MaterialId material) { return static_cast<std::uint32_t>(material); }
}  // namespace

void RayshadeWriter::view(const View& view) {
  out_.write("background 0.078 0.361 0.753\neyep ", view.eye, "\nlookp ", view.lookAt, "\nup ", view.up,
             "\nfov ", view.fieldOfView, ' ', view.fieldOfView,
             "\nscreen 512 512\nsample 1 nojitter\nmaxdepth 5\ncutoff 0.0039\n");
}

void RayshadeWriter::light(Vec3 position, double intensity) {
  out_.write("light ", Color{intensity, intensity, intensity}, " point ", position, '\n');
}

MaterialId RayshadeWriter::material(const Material& m) {
  const MaterialId id{materials_++};
  out_.write("surface M", number(id), " ambient ", m.ambient, " diffuse ", m.diffuse);
  if (m.specular > 0) {
    out_.write(" specular ", Color{m.specular, m.specular, m.specular}, " specpow ", m.specularPower,
               " reflect ", m.reflect);
  }
  if (m.transparency > 0) out_.write(" transp ", m.transparency, " index ", m.index);
  out_.write('\n');
  return id;
}

void RayshadeWriter::beginCrowd(std::uint64_t primitives) {
  if (!grid_) return;
  const double side = std::max(1.0, std::round(1.5 * elementary::cbrt(static_cast<double>(primitives))));
  out_.write("grid ", Vec3{side, side, side}, '\n');
}

void RayshadeWriter::endCrowd() {
  if (grid_) out_.write("end\n");
}

void RayshadeWriter::sphere(MaterialId material, Vec3 centre, double radius) {
  out_.write("sphere M", number(material), ' ', radius, ' ', centre, '\n');
}

void RayshadeWriter::cylinder(MaterialId material, double radius, Vec3 base, Vec3 top) {
  out_.write("cylinder M", number(material), ' ', radius, ' ', base, ' ', top, '\n');
}

void RayshadeWriter::cone(MaterialId material, double baseRadius, Vec3 base, double topRadius, Vec3 top) {
  out_.write("cone M", number(material), ' ', baseRadius, ' ', base, ' ', topRadius, ' ', top, '\n');
}

void RayshadeWriter::polygon(MaterialId material, std::span<const Vec3> corners) {
  out_.write("polygon M", number(material));
  for (std::size_t i = 0; i < corners.size(); ++i) out_.write(i % 4 == 0 && i > 0 ? "\n " : " ", corners[i]);
  out_.write('\n');
}

void RayshadeWriter::triangle(MaterialId material, const Vec3 (&corners)[3]) {
  out_.write("triangle M", number(material), ' ', corners[0], ' ', corners[1], ' ', corners[2], '\n');
}

void RayshadeWriter::smoothTriangle(MaterialId material, const Vec3 (&corners)[3], const Vec3 (&normals)[3]) {
  out_.write("triangle M", number(material));
  for (int i = 0; i < 3; ++i) out_.write(' ', corners[i], ' ', normals[i]);
  out_.write('\n');
}

}  // namespace rayshade::spd
