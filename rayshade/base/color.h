// Linear RGB: radiance, reflectance or transmittance, unclamped.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "rayshade/base/archive.h"

namespace rayshade {

struct Color {
  double r = 0, g = 0, b = 0;

  friend constexpr bool operator==(const Color&, const Color&) = default;
};

inline constexpr Color kBlack{0, 0, 0};
inline constexpr Color kWhite{1, 1, 1};

constexpr Color operator+(Color a, Color b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
constexpr Color operator-(Color a, Color b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
constexpr Color operator*(Color a, Color b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
constexpr Color operator*(Color a, double s) { return {a.r * s, a.g * s, a.b * s}; }
constexpr Color operator*(double s, Color a) { return a * s; }

constexpr bool anyAbove(Color c, double limit) { return c.r > limit || c.g > limit || c.b > limit; }
constexpr bool anyAbove(Color c, Color limit) { return c.r > limit.r || c.g > limit.g || c.b > limit.b; }
// Light that is more than anything in a picture can be, and still far from infinite in single precision.
inline constexpr double kMostLight = 1e30;
constexpr Color limited(Color c) {
  return {std::clamp(c.r, -kMostLight, kMostLight), std::clamp(c.g, -kMostLight, kMostLight),
          std::clamp(c.b, -kMostLight, kMostLight)};
}

inline bool isFinite(Color c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }
constexpr double largest(Color c) { return std::max({c.r, c.g, c.b}); }

template <class Archive>
void serialize(Archive& archive, Color& c) {
  archive(c.r, c.g, c.b);
}

// Most light that is let through is all or nothing: one byte then.
template <class Archive>
void serializeCompact(Archive& archive, Color& c) {
  enum class Form : std::uint8_t { black, white, other };
  Form form = Form::other;
  if constexpr (!Archive::kReading)
    form = sameBits(c, kBlack) ? Form::black : sameBits(c, kWhite) ? Form::white : form;
  archive(form);
  if (form == Form::other) {
    archive(c);
  } else if (form <= Form::white) {
    c = form == Form::black ? kBlack : kWhite;
  } else {
    if constexpr (Archive::kReading) archive.fail();
  }
}

}  // namespace rayshade
