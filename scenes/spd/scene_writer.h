// Where a generated scene goes: one call per item, nothing is kept, so a scene may be larger than memory.
//
// Three languages: Rayshade 4, POV-Ray 3.7, Tachyon 0.99.  All lengths are world units, angles degrees, colours
// linear RGB; right-handed coordinates, z up in most scenes.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <ostream>
#include <span>
#include <string_view>

#include "rayshade/base/color.h"
#include "rayshade/base/vec.h"

namespace rayshade::spd {

struct View {
  Vec3 eye, lookAt, up{0, 0, 1};
  double fieldOfView = 45;  // both ways: the pictures are square
};

struct Material {
  Color ambient, diffuse;
  double specular = 0, specularPower = 0;  // Phong highlight
  double reflect = 0;                      // times specular
  double transparency = 0, index = 1;
};

enum class MaterialId : std::uint32_t {};

class SceneWriter {
 public:
  virtual ~SceneWriter() = default;

  virtual void view(const View& view) = 0;
  virtual void light(Vec3 position, double intensity) = 0;
  virtual MaterialId material(const Material& material) = 0;

  // The crowd: all that is not a floor.  `primitives` is how many are to come.
  virtual void beginCrowd(std::uint64_t primitives) = 0;
  virtual void endCrowd() = 0;

  virtual void sphere(MaterialId material, Vec3 centre, double radius) = 0;
  virtual void cylinder(MaterialId material, double radius, Vec3 base, Vec3 top) = 0;
  virtual void cone(MaterialId material, double baseRadius, Vec3 base, double topRadius, Vec3 top) = 0;
  // Planar; the corners counter-clockwise, seen from its middle.
  virtual void polygon(MaterialId material, std::span<const Vec3> corners) = 0;
  virtual void triangle(MaterialId material, const Vec3 (&corners)[3]) = 0;
  virtual void smoothTriangle(MaterialId material, const Vec3 (&corners)[3], const Vec3 (&normals)[3]) = 0;

  virtual void finish() = 0;
};

struct WriterOptions {
  std::string_view format = "rayshade";  // "rayshade", "pov" or "tachyon"
  bool grid = false;  // Rayshade only: put the crowd into a grid of 1.5 cbrt(N) voxels a side
};

// Null when the format is not known.
std::unique_ptr<SceneWriter> makeWriter(const WriterOptions& options, std::ostream& out);

}  // namespace rayshade::spd
