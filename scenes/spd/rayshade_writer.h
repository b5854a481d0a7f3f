// A scene in the language of Rayshade 4.
//
// The settings are those of the usual comparisons: 512 x 512, one sample per pixel, depth 5.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenes/spd/scene_writer.h"
#include "scenes/spd/text_output.h"

namespace rayshade::spd {

class RayshadeWriter : public SceneWriter {
 public:
  RayshadeWriter(std::ostream& out, bool grid) : out_(out, " "), grid_(grid) {}

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
  bool grid_;
  std::uint32_t materials_ = 0;
};

}  // namespace rayshade::spd
