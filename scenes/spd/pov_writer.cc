#include "scenes/spd/pov_writer.h"

namespace rayshade::spd {

namespace {

std::uint32_t number(MaterialId material) { return static_cast<std::uint32_t>(material); }

double ratio(double numerator, double denominator) { return denominator > 0 ? numerator / denominator : 0; }

}  // namespace

void PovWriter::view(const View& view) {
  out_.write("#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level 6 adc_bailout 0.0039 }\n",
             "background { color rgb <0.078, 0.361, 0.753> }\ncamera {\n  location <", view.eye,
             ">\n  up y\n  right -x\n  angle ", view.fieldOfView, "\n  sky <", view.up, ">\n  look_at <",
             view.lookAt, ">\n}\n");
}

void PovWriter::light(Vec3 position, double intensity) {
  out_.write("light_source { <", position, "> color rgb ", intensity, " }\n");
}

MaterialId PovWriter::material(const Material& m) {
  const MaterialId id{materials_++};
  // POV-Ray dims the diffuse and ambient terms of a transparent surface; Rayshade does not.
  const double dimmed = 1 - m.transparency;
  const Color pigment = m.diffuse * (1 / dimmed);
  const Color ambient{ratio(m.ambient.r, m.diffuse.r), ratio(m.ambient.g, m.diffuse.g),
                      ratio(m.ambient.b, m.diffuse.b)};
  out_.write("#declare M", number(id), " = material { texture { pigment { color rgb <", pigment,
             "> transmit ", m.transparency, " } finish { ambient rgb <", ambient, "> diffuse 1 phong ",
             m.specular);
  out_.write(" phong_size ", m.specularPower, " reflection ", m.specular * m.reflect, " } } interior { ior ",
             m.index, " } }\n");
  return id;
}

void PovWriter::beginCrowd(std::uint64_t) {}
void PovWriter::endCrowd() {}

void PovWriter::sphere(MaterialId material, Vec3 centre, double radius) {
  out_.write("sphere { <", centre, ">, ", radius, " material { M", number(material), " } }\n");
}

void PovWriter::cylinder(MaterialId material, double radius, Vec3 base, Vec3 top) {
  out_.write("cylinder { <", base, ">, <", top, ">, ", radius, " open material { M", number(material),
             " } }\n");
}

void PovWriter::cone(MaterialId material, double baseRadius, Vec3 base, double topRadius, Vec3 top) {
  out_.write("cone { <", base, ">, ", baseRadius, ", <", top, ">, ", topRadius, " open material { M",
             number(material), " } }\n");
}

void PovWriter::polygon(MaterialId material, std::span<const Vec3> corners) {
  out_.write("polygon { ", static_cast<std::uint32_t>(corners.size() + 1));
  for (const Vec3& corner : corners) out_.write(",\n  <", corner, '>');
  out_.write(",\n  <", corners.front(), ">\n  material { M", number(material), " } }\n");
}

void PovWriter::triangle(MaterialId material, const Vec3 (&corners)[3]) {
  out_.write("triangle { <", corners[0], ">, <", corners[1], ">, <", corners[2], "> material { M",
             number(material), " } }\n");
}

void PovWriter::smoothTriangle(MaterialId material, const Vec3 (&corners)[3], const Vec3 (&normals)[3]) {
  out_.write("smooth_triangle { ");
  for (int i = 0; i < 3; ++i) out_.write(i > 0 ? ", <" : "<", corners[i], ">, <", normals[i], '>');
  out_.write(" material { M", number(material), " } }\n");
}

}  // namespace rayshade::spd
