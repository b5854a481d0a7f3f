// A scene in the language of Tachyon 0.99.
//
// Tachyon has no refraction, no cone and no polygon: glass is merely transparent, a cone becomes a cylinder of the
// middle radius, a polygon a fan of triangles around its middle.  Its camera is left-handed: the world is mirrored, x to
// -x, so that the picture is not.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenes/spd/scene_writer.h"
#include "scenes/spd/text_output.h"

namespace rayshade::spd {

class TachyonWriter : public SceneWriter {
 public:
  explicit TachyonWriter(std::ostream& out) : out_(out, " ") {}

  void view(const View& view) override;
  void light(Vec3 position, double intensity) override;
  MaterialId material(const Material& material) override;
  void beginCrowd(std::uint64_t primitives) override;
  void endCrowd() override;
  void sphere(MaterialId material, Vec3 centre, double radius) override;
  void cylinder(MaterialId material, double radius, Vec3 base, Vec3 top) override;
  void cone(MaterialId material, double baseRadius, Vec3 base, double topRadius, Vec3 top) override;
  void polygon(MaterialId material, std::span<const Vec3> corners) override;
  void triangle(MaterialId material, const Vec3 (&corners)[3]) override;
  void smoothTriangle(MaterialId material, const Vec3 (&corners)[3], const Vec3 (&normals)[3]) override;
  void finish() override;

 private:
  TextOutput out_;
  std::uint32_t materials_ = 0;
};

}  // namespace rayshade::spd
