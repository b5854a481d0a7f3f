// A scene in the language of POV-Ray 3.7.
//
// POV-Ray has one colour per surface and scales it: the colour is the diffuse one, the ambient term its multiple.
// Render with  povray +Iscene.pov +W512 +H512 -A ; POV-Ray is left-handed, a mirrored camera puts that right.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenes/spd/scene_writer.h"
#include "scenes/spd/text_output.h"

namespace rayshade::spd {

class PovWriter : public SceneWriter {
 public:
  explicit PovWriter(std::ostream& out) : out_(out, ", ") {}

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
  void finish() override { out_.flush(); }

 private:
  TextOutput out_;
  std::uint32_t materials_ = 0;
};

}  // namespace rayshade::spd
