// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/transform.h"

#include <numbers>

#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

Matrix transposed(const Matrix& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}, {0, 0, 0}};
}

// A rotation about a unit axis, by its sine and cosine (Rodrigues).
Matrix rotationMatrix(Vec3 n, double c, double s) {
  const double v = 1 - c;
  return {{n.x * n.x * v + c, n.x * n.y * v + s * n.z, n.x * n.z * v - s * n.y},
          {n.x * n.y * v - s * n.z, n.y * n.y * v + c, n.y * n.z * v + s * n.x},
          {n.x * n.z * v + s * n.y, n.y * n.z * v - s * n.x, n.z * n.z * v + c},
          {0, 0, 0}};
}

}  // namespace

Matrix product(const Matrix& a, const Matrix& b) {
  return {mapVector(b, a.x), mapVector(b, a.y), mapVector(b, a.z), mapPoint(b, a.origin)};
}

Affine then(const Affine& first, const Affine& second) {
  return {product(first.forward, second.forward), product(second.inverse, first.inverse)};
}

bool isInvertible(const Affine& a) {
  constexpr double kNearly = 0x1p-4;
  const Matrix round = product(a.forward, a.inverse), identity;
  const auto near = [](Vec3 row, Vec3 axis) { return isFinite(row) && maxAbs(row - axis) < kNearly; };
  return isFinite(a.forward.origin) && isFinite(a.inverse.origin) && near(round.x, identity.x) &&
         near(round.y, identity.y) && near(round.z, identity.z);
}

Affine translation(Vec3 by) {
  Affine a;
  a.forward.origin = by;
  a.inverse.origin = -by;
  return a;
}

std::optional<Affine> scaling(Vec3 by) {
  const Vec3 back{1 / by.x, 1 / by.y, 1 / by.z};
  if (by.x == 0 || by.y == 0 || by.z == 0 || !isFinite(by) || !isFinite(back)) return std::nullopt;
  return Affine{{{by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {}},
                {{back.x, 0, 0}, {0, back.y, 0}, {0, 0, back.z}, {}}};
}

Affine rotation(Vec3 axis, double degrees) {
  const Vec3 n = normalize(axis);
  if (n == Vec3{}) return {};
  const double angle = degrees * std::numbers::pi / 180;
  const Matrix m = rotationMatrix(n, elementary::cos(angle), elementary::sin(angle));
  return {m, transposed(m)};
}

std::optional<Affine> linearMap(const Matrix& m) {
  const Vec3 yz = cross(m.y, m.z), zx = cross(m.z, m.x), xy = cross(m.x, m.y);
  const double determinant = dot(m.x, yz);
  // Singular in proportion to its rows: an absolute limit would refuse small scenes.
  const double volume = length(m.x) * length(m.y) * length(m.z);
  if (!std::isfinite(determinant) || !(std::abs(determinant) > 1e-14 * volume)) return std::nullopt;
  // The inverse has the crossed rows as columns, divided by the determinant.
  Matrix inverse{Vec3{yz.x, zx.x, xy.x} / determinant,
                 Vec3{yz.y, zx.y, xy.y} / determinant,
                 Vec3{yz.z, zx.z, xy.z} / determinant,
                 {}};
  inverse.origin = -mapVector(inverse, m.origin);
  if (!isFinite(inverse.x) || !isFinite(inverse.y) || !isFinite(inverse.z) || !isFinite(inverse.origin))
    return std::nullopt;
  return Affine{m, inverse};
}

// scale(radius, radius, height), then the shortest rotation that takes +z to the axis, then translate(base).
Affine alongAxis(Vec3 base, Vec3 axis, double radius, double height) {
  const Vec3 a = normalize(axis);
  const double sine = elementary::hypot(a.x, a.y);
  const Vec3 turn = sine > 0 ? Vec3{-a.y / sine, a.x / sine, 0} : Vec3{1, 0, 0};
  const Matrix m = rotationMatrix(turn, a.z, sine);
  const Affine rotate{m, transposed(m)};
  const Affine scale{{{radius, 0, 0}, {0, radius, 0}, {0, 0, height}, {}},
                     {{1 / radius, 0, 0}, {0, 1 / radius, 0}, {0, 0, 1 / height}, {}}};
  return then(then(scale, rotate), translation(base));
}

Bounds mapBounds(const Affine& a, const Bounds& bounds) {
  if (bounds.empty()) return bounds;
  Bounds image;
  const Matrix& m = a.forward;
  for (int axis = 0; axis < 3; ++axis) {
    double low = m.origin[axis], high = m.origin[axis];
    const double factor[3] = {m.x[axis], m.y[axis], m.z[axis]};
    for (int from = 0; from < 3; ++from) {
      if (factor[from] == 0) continue;  // 0 times infinity would be NaN
      const double p = factor[from] * bounds.low[from], q = factor[from] * bounds.high[from];
      low += std::min(p, q);
      high += std::max(p, q);
    }
    image.low[axis] = low;
    image.high[axis] = high;
  }
  return image;
}

bool TransformChain::moves() const {
  for (const auto& step : steps)
    if (std::holds_alternative<MovingStep>(step)) return true;
  return false;
}

void TransformChain::append(const Affine& affine) {
  if (!steps.empty() && std::holds_alternative<Affine>(steps.back())) {
    Affine& last = std::get<Affine>(steps.back());
    last = then(last, affine);
  } else {
    steps.emplace_back(affine);
  }
}

void TransformChain::append(MovingStep step) { steps.emplace_back(std::move(step)); }

std::optional<Affine> stepAt(const MovingStep& step, const Moment& moment) {
  double v[12] = {};
  const std::size_t count = std::min<std::size_t>(step.arguments.size(), 12);
  for (std::size_t i = 0; i < count; ++i) v[i] = evaluate(step.arguments[i], moment);
  switch (step.kind) {
    case MovingStep::Kind::translate:
      return translation({v[0], v[1], v[2]});
    case MovingStep::Kind::scale:
      return scaling({v[0], v[1], v[2]});
    case MovingStep::Kind::rotate:
      return rotation({v[0], v[1], v[2]}, v[3]);
    case MovingStep::Kind::transform:
      return linearMap({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, {v[9], v[10], v[11]}});
  }
  return std::nullopt;
}

std::optional<Affine> chainAt(const TransformChain& chain, const Moment& moment) {
  Affine whole;
  for (const auto& step : chain.steps) {
    if (const Affine* constant = std::get_if<Affine>(&step)) {
      whole = then(whole, *constant);
    } else if (const auto moving = stepAt(std::get<MovingStep>(step), moment)) {
      whole = then(whole, *moving);
    } else {
      return std::nullopt;
    }
  }
  return whole;
}

}  // namespace rayshade
