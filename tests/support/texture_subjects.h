// Textures from words, places where they are asked, and files for them.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "rayshade/textures/apply.h"
#include "tests/support/text_arguments.h"

namespace rayshade {

inline constexpr double kClose = 1e-12;
inline constexpr Vec3 kPlace{1.25, -3.7,
                             8.125};  // where the reference values were computed, by another program

inline void expectNear(Vec3 a, Vec3 b) {
  EXPECT_NEAR(a.x, b.x, kClose);
  EXPECT_NEAR(a.y, b.y, kClose);
  EXPECT_NEAR(a.z, b.z, kClose);
}

inline void expectNear(Color a, Color b) { expectNear(Vec3{a.r, a.g, a.b}, Vec3{b.r, b.g, b.b}); }

// A white surface that looks up.
inline TextureHit hitAt(Vec3 position) {
  TextureHit hit;
  hit.position = position;
  hit.normal = {0, 0, 1};
  hit.dpdu = {1, 0, 0};
  hit.dpdv = {0, 1, 0};
  hit.surface.ambient = hit.surface.diffuse = hit.surface.specular = kWhite;
  return hit;
}

inline TextureHit hitAtUv(double u, double v) {
  TextureHit hit = hitAt({});
  hit.u = u;
  hit.v = v;
  return hit;
}

template <class T>
T parsed(const std::string& text) {
  TextArguments in(text);
  const std::optional<T> texture = T::parse(in);
  EXPECT_TRUE(texture && in.allTaken()) << T::keyword << " " << text;
  return *texture;
}

template <class T>
TextureHit applied(const std::string& text, TextureHit hit) {
  parsed<T>(text).apply(hit);
  return hit;
}

// A file that lives as long as the test.
class TextureFile {
 public:
  TextureFile(const std::string& name, const std::string& contents)
      : path_(std::filesystem::temp_directory_path() /
              ("rayshade-textures-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + name)) {
    std::ofstream(path_, std::ios::binary) << contents;
  }
  ~TextureFile() { std::filesystem::remove(path_); }
  TextureFile(const TextureFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace rayshade
