// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/shapes/blob.h"

#include <cstdint>

#include "rayshade/base/roots.h"

namespace rayshade {
namespace {

// The part of a ray inside of the sphere of influence of one ball.
struct Span {
  double enter, leave;
  double radius, strength;
};

// (t - enter)(leave - t) / radius^2 with the two t told apart (its blossom): not negative for s and t in the
// span.
double blossom(const Span& span, double s, double t) {
  const double r = span.radius;
  return 0.5 *
         ((s - span.enter) / r * ((span.leave - t) / r) + (t - span.enter) / r * ((span.leave - s) / r));
}

// A quartic on an interval, by its Bernstein coefficients: its values lie between the least and the largest.
using Bernstein = Quartic;

Bernstein densityOf(const Span& span, double from, double to) {
  const double a = blossom(span, from, from), b = blossom(span, from, to), c = blossom(span, to, to);
  const double s = span.strength;
  return {s * a * a, s * a * b, s * (2 * b * b + a * c) / 3, s * b * c, s * c * c};
}

double largestDensity(const Span& span) {
  const double half = (span.leave - span.enter) / (2 * span.radius);
  return span.strength * (half * half) * (half * half);
}

// The two parts of a quartic, cut at the share `at` of its interval.
struct Halves {
  Bernstein left, right;
};
Halves cut(Bernstein c, double at) {
  Halves halves;
  for (std::size_t level = 0; level < 5; ++level) {
    halves.left[level] = c[0];
    halves.right[4 - level] = c[4 - level];
    for (std::size_t i = 0; i + level < 4; ++i) c[i] = (1 - at) * c[i] + at * c[i + 1];
  }
  return halves;
}

Quartic powersOf(const Bernstein& c) {
  const double d0 = c[1] - c[0], d1 = c[2] - c[1], d2 = c[3] - c[2], d3 = c[4] - c[3];
  const double e0 = d1 - d0, e1 = d2 - d1, e2 = d3 - d2;
  return {c[0], 4 * d0, 6 * e0, 4 * (e1 - e0), (e2 - e1) - (e1 - e0)};
}

// Finds the first crossing of the skin beyond tMin, interval by interval from the start of the ray.  Spans
// and cuts are measured from the foot, tMin and the hit from the origin of the ray.
class Search {
 public:
  Search(std::vector<Span> spans, double threshold, double tFoot, double tMin)
      : spans_(std::move(spans)), threshold_(threshold), tFoot_(tFoot), tMin_(tMin) {
    for (const Span& span : spans_) {
      cuts_.push_back(span.enter);
      cuts_.push_back(span.leave);
    }
    std::sort(cuts_.begin(), cuts_.end());
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
    for (std::uint32_t i = 0; i < spans_.size(); ++i) waiting_.push_back(i);
  }

  double first() {
    if (cuts_.size() < 2) return kNoHit;
    visit(0, cuts_.size() - 1, {}, 0);
    if (hit_ == kNoHit) startAt(cuts_.back(), false);
    return hit_;
  }

 private:
  // The intervals between cuts_[first] and cuts_[last]: `density` is the sum of the balls that cover all of
  // them and were counted on the way down; those from waiting_[begin] on may cover more or fewer.
  void visit(std::size_t first, std::size_t last, Bernstein density, std::size_t begin) {
    const double from = cuts_[first], to = cuts_[last];
    const std::size_t end = waiting_.size();
    double atMost = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Span& span = spans_[waiting_[i]];
      if (span.enter >= to || span.leave <= from) continue;
      if (span.enter <= from && span.leave >= to) {
        const Bernstein more = densityOf(span, from, to);
        for (std::size_t k = 0; k < 5; ++k) density[k] += more[k];
      } else {
        waiting_.push_back(waiting_[i]);
        atMost += largestDensity(span);
      }
    }
    atMost += *std::max_element(density.begin(), density.end());
    if (atMost < threshold_) {
      startAt(from, false);
    } else if (last - first == 1) {
      solve(from, to, density);
    } else {
      const std::size_t middle = first + (last - first) / 2;
      const Halves halves = cut(density, (cuts_[middle] - from) / (to - from));
      visit(first, middle, halves.left, end);
      if (hit_ == kNoHit) visit(middle, last, halves.right, end);
    }
    waiting_.resize(end);
  }

  // One quartic holds between `from` and `to`.
  void solve(double from, double to, Bernstein density) {
    for (double& value : density) value -= threshold_;
    const Quartic quartic = powersOf(density);
    startAt(from, evaluate(quartic, 0) >= 0);
    for (const double x : rootsBetween(quartic, 0, 1)) take(std::min(from + x * (to - from), to));
    inside_ = evaluate(quartic, 1) >= 0;
  }

  // Neighbouring quartics agree where they meet but for rounding: a skin that both just miss is there.
  void startAt(double t, bool inside) {
    if (inside != inside_) take(t);
    inside_ = inside;
  }

  void take(double afterFoot) {
    const double t = tFoot_ + afterFoot;
    if (t > tMin_ && hit_ == kNoHit) hit_ = t;
  }

  std::vector<Span> spans_;
  std::vector<double> cuts_;
  std::vector<std::uint32_t> waiting_;  // a stack of lists of spans
  double threshold_, tFoot_, tMin_;
  bool inside_ = false;
  double hit_ = kNoHit;
};

// Density less threshold at a point, with what is needed to say how far the skin may be.
struct Field {
  double value, error;  // and the largest error of the value
  Vec3 gradient;
  double bend;  // at least the largest second derivative of the density hereabouts
};
Field fieldAt(const Blob& blob, Vec3 p) {
  Field f{-blob.threshold, blob.threshold, {}, 0};
  for (const Metaball& ball : blob.balls) {
    const Vec3 fromCentre = (p - ball.centre) / ball.radius;
    const double squared = dot(fromCentre, fromCentre), inside = 1 - squared;
    if (squared < 4) f.bend += 8 * ball.strength / ball.radius / ball.radius;
    if (!(inside > 0)) continue;
    f.value += ball.strength * inside * inside;
    f.error += ball.strength;
    f.gradient = f.gradient - (4 * ball.strength / ball.radius * inside) * fromCentre;
  }
  f.error *= 8 * kRounding;
  return f;
}

// At most this far is the skin from the point where the field was taken.  The density falls short by `gap`;
// going up the gradient the first order alone closes it within 2 gap/slope, if the bend is small enough.
double distanceToSkin(const Field& f) {
  const double gap = std::abs(f.value) + f.error, slope = length(f.gradient);
  if (slope * slope >= 2 * f.bend * gap && slope > 0) return 2 * gap / slope;
  return std::sqrt(2 * gap / f.bend) * 2;  // a crest or a saddle: as far as its bend allows
}

}  // namespace

std::optional<Blob> Blob::parse(Arguments& in) {
  Blob blob;
  blob.threshold = in.number();
  // differs from rayshade4: no least strength or radius, but without a positive threshold there is no skin
  bool good = std::isfinite(blob.threshold) && blob.threshold > 0;
  do {
    Metaball ball;
    ball.strength = in.number();
    ball.radius = in.number();
    ball.centre = in.vector();
    good = good && ball.strength > 0 && ball.radius > 0 && std::isfinite(ball.strength + ball.radius) &&
           isFinite(ball.centre);
    blob.balls.push_back(ball);
  } while (in.numberFollows());
  return good ? std::optional(std::move(blob)) : std::nullopt;
}

Bounds Blob::bounds() const {
  Bounds all;
  for (const Metaball& ball : balls) {
    const Vec3 r{ball.radius, ball.radius, ball.radius};
    all = join(all, Bounds{ball.centre - r, ball.centre + r});
  }
  return all;
}

// differs from rayshade4: a ray that starts on the skin and goes inside finds the far side (the original
// loses the interval, and with it 61 % of the exits of a single ball).
double Blob::intersect(const LocalRay& ray, double tMin) const {
  if (balls.empty()) return kNoHit;
  // All is measured from the point nearest to the first ball, so that a far origin costs accuracy only once.
  const double tFoot = -dot(ray.origin - balls[0].centre, ray.direction);
  const Vec3 foot = ray.origin + tFoot * ray.direction;
  std::vector<Span> spans;
  for (const Metaball& ball : balls) {
    const Vec3 f = foot - ball.centre;
    const double middle = -dot(f, ray.direction);
    const Vec3 h = (f + middle * ray.direction) / ball.radius;
    const double quarter = 1 - dot(h, h);
    if (!(quarter > 0)) continue;
    const double half = ball.radius * std::sqrt(quarter);
    spans.push_back({middle - half, middle + half, ball.radius, ball.strength});
  }
  if (spans.empty()) return kNoHit;
  return Search(std::move(spans), threshold, tFoot, tMin).first();
}

ShapePoint Blob::pointAt(const LocalRay& ray, double t) const {
  Vec3 p = ray.origin + t * ray.direction;
  Field field = fieldAt(*this, p);
  for (int step = 0; step < 3; ++step) {
    const Vec3 moved = p - field.gradient * (field.value / dot(field.gradient, field.gradient));
    if (!isFinite(moved)) break;
    const Field there = fieldAt(*this, moved);
    if (!(std::abs(there.value) < std::abs(field.value))) break;
    p = moved;
    field = there;
  }
  Vec3 outward = normalize(-field.gradient);
  if (outward == Vec3{}) outward = -ray.direction;  // the top of a ball that just reaches the threshold
  return {p, outward, outward, {}, distanceToSkin(field), kInfinity};
}

}  // namespace rayshade
