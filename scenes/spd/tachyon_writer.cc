#include "scenes/spd/tachyon_writer.h"

#include <numbers>

#include "rayshade/base/elementary.h"

namespace rayshade::spd {

namespace {
std::uint32_t number(MaterialId material) { return static_cast<std::uint32_t>(material); }
Vec3 mirrored(Vec3 v) { return {-v.x, v.y, v.z}; }
}  // namespace

void TachyonWriter::view(const View& view) {
  // Zoom 1 is a picture one unit wide at distance one.
  const double zoom = 0.5 / elementary::tan(view.fieldOfView * std::numbers::pi / 360);
  out_.write("BEGIN_SCENE\nRESOLUTION 512 512\nCAMERA\n  ZOOM ", zoom,
             "\n  ASPECTRATIO 1.0\n  ANTIALIASING 0\n  RAYDEPTH 6\n  CENTER ", mirrored(view.eye),
             "\n  VIEWDIR ", mirrored(normalize(view.lookAt - view.eye)), "\n  UPDIR ", mirrored(view.up),
             "\nEND_CAMERA\nBACKGROUND 0.078 0.361 0.753\n");
}

void TachyonWriter::light(Vec3 position, double intensity) {
  out_.write("LIGHT CENTER ", mirrored(position), " RAD 0.001 COLOR ", Color{intensity, intensity, intensity},
             '\n');
}

MaterialId TachyonWriter::material(const Material& m) {
  const MaterialId id{materials_++};
  const double strongest = largest(m.diffuse);
  const double ambient = strongest > 0 ? largest(m.ambient) / strongest : 0;
  out_.write("TEXDEF M", number(id), " AMBIENT ", ambient, " DIFFUSE 1 SPECULAR ", m.specular * m.reflect,
             " OPACITY ", 1 - m.transparency, " PHONG PLASTIC ", m.specular);
  out_.write(" PHONG_SIZE ", m.specularPower, " COLOR ", m.diffuse, " TEXFUNC 0\n");
  return id;
}

void TachyonWriter::beginCrowd(std::uint64_t) {}
void TachyonWriter::endCrowd() {}

void TachyonWriter::sphere(MaterialId material, Vec3 centre, double radius) {
  out_.write("SPHERE CENTER ", mirrored(centre), " RAD ", radius, " M", number(material), '\n');
}

void TachyonWriter::cylinder(MaterialId material, double radius, Vec3 base, Vec3 top) {
  out_.write("FCYLINDER BASE ", mirrored(base), " APEX ", mirrored(top), " RAD ", radius, " M",
             number(material), '\n');
}

void TachyonWriter::cone(MaterialId material, double baseRadius, Vec3 base, double topRadius, Vec3 top) {
  cylinder(material, (baseRadius + topRadius) / 2, base, top);
}

void TachyonWriter::polygon(MaterialId material, std::span<const Vec3> corners) {
  Vec3 sum;
  for (const Vec3& corner : corners) sum = sum + corner;
  const Vec3 middle = sum / static_cast<double>(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    triangle(material, {middle, corners[i], corners[(i + 1) % corners.size()]});
  }
}

void TachyonWriter::triangle(MaterialId material, const Vec3 (&corners)[3]) {
  out_.write("TRI V0 ", mirrored(corners[0]), " V1 ", mirrored(corners[1]), " V2 ", mirrored(corners[2]),
             " M", number(material), '\n');
}

void TachyonWriter::smoothTriangle(MaterialId material, const Vec3 (&corners)[3], const Vec3 (&normals)[3]) {
  // The order is turned round, for a mirrored triangle winds the other way.
  out_.write("STRI V0 ", mirrored(corners[0]), " V1 ", mirrored(corners[2]), " V2 ", mirrored(corners[1]));
  out_.write(" N0 ", mirrored(normals[0]), " N1 ", mirrored(normals[2]), " N2 ", mirrored(normals[1]), " M",
             number(material), '\n');
}

void TachyonWriter::finish() {
  out_.write("END_SCENE\n");
  out_.flush();
}

}  // namespace rayshade::spd
