// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/csg.h"

#include "rayshade/intersect/ray_hit.h"

namespace rayshade {
namespace {

// The cosine between a ray and the outward normal where it crosses a surface.  Nothing: it only touches it.  Where a surface is bent
// a cosine of c means that the ray gets as deep as c^2 / 2 of its radius: that may be less than rounding.
std::optional<double> crossingCosine(const ShapePoint& point, const LocalRay& ray) {
  const double cosine = dot(ray.direction, point.geometricNormal);
  if (cosine == 0 || (point.curvature > 0 && std::abs(cosine) < 0x1p-25)) return std::nullopt;
  return cosine;
}

// That of the ray and the object at its crossing at t; 1 or -1 where a CSG operation says what it is.
std::optional<double> cosineAt(const Model& model, ObjectIndex index, const LocalRay& outer,
                               const Moment& moment, double t) {
  const SceneStore& store = model.store();
  const PlacedObject& object = store.object(index);
  const LocalRay ray = intoNode(store, object.node, outer, moment);
  if (object.kind == kCsgKind)
    return crossingAt(model, model.solid(object.body), ray, moment, t).entering ? -1 : 1;
  if (object.kind == kInstanceKind) {
    const Hit inside = hitAt(model, model.definition(store.instance(object)), ray, moment, t);
    return inside.found() ? cosineAt(model, inside.object, ray, moment, t) : std::nullopt;
  }
  return crossingCosine(pointAt(model, {index, ray}, t), ray);
}

// A crossing of a leaf.
struct LeafCrossing {
  double t = 0;       // world units
  double error = 0;   // of the surface there, along the ray if it were square to it
  double cosine = 0;  // between the ray and the outward normal; 0: not asked for yet
  std::uint32_t leaf = 0;
  bool entering = false;
  bool insideAfter = false;  // as the next crossing of the leaf has it
  bool silent = false;       // changes where the ray is, and shows nothing
  bool taken = false;
};

// The rays in the spaces of a solid's leaves, each found once.
class LocalRays {
 public:
  LocalRays(const Model& model, const Solid& solid, const LocalRay& ray, const Moment& moment)
      : store_(model.store()), solid_(solid), ray_(ray), moment_(moment) {}

  LocalRay at(std::uint32_t step) { return step == kNone ? ray_ : inSpace(solid_.steps[step].space); }

 private:
  LocalRay inSpace(std::uint32_t space) {
    if (space == kNone) return ray_;
    for (const Found& found : found_)
      if (found.space == space) return found.ray;
    const Solid::Step& step = solid_.steps[space];
    const LocalRay outer = at(step.outer);
    const NodeIndex node = store_.object(step.object).node;
    const LocalRay inner = outer.scale > 0 ? intoNode(store_, node, outer, moment_) : kNowhere;
    found_.push_back({space, inner});
    return inner;
  }

  struct Found {
    std::uint32_t space = 0;
    LocalRay ray;
  };
  const SceneStore& store_;
  const Solid& solid_;
  const LocalRay& ray_;
  const Moment& moment_;
  InlineVector<Found, 4> found_;
};

// Which operations a ray is inside of: those of a solid that it does not touch have nothing inside.
class Insides {
 public:
  explicit Insides(const Solid& solid) : solid_(solid), states_(solid.operations.size()) {}

  bool inside(std::uint32_t operation) const {
    const State& state = states_[operation];
    switch (solid_.operations[operation].kind) {
      case CsgOperation::unite:
        return state.inside > 0;
      case CsgOperation::intersect:
        return state.inside == solid_.operations[operation].operands;
      case CsgOperation::subtract:
        return state.insideFirst && state.inside == 1;
    }
    return false;
  }

  // An operand at this place is now inside, or outside: it was the other.
  void change(Solid::Place place, bool now) {
    while (place.operation != kNone) {
      State& state = states_[place.operation];
      const bool before = inside(place.operation);
      state.inside += now ? 1u : ~0u;
      if (place.first) state.insideFirst = now;
      now = inside(place.operation);
      if (now == before) return;
      place = solid_.operations[place.operation].place;
    }
  }

 private:
  struct State {
    std::uint32_t inside = 0;  // of its operands
    bool insideFirst = false;
  };
  const Solid& solid_;
  InlineVector<State, 8> states_;
};

// The part of a ray in a box [world units]; from > to: none.
struct Passage {
  double from = 0, to = kInfinity;
};
Passage passage(const Bounds& box, const LocalRay& ray) {
  Passage part;
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin[axis], direction = ray.direction[axis] * ray.scale;
    const double toLow = box.low[axis] - origin, toHigh = box.high[axis] - origin;
    if (direction == 0) {
      if (!(toLow <= 0 && toHigh >= 0)) return {1, 0};
      continue;
    }
    part.from = std::max(part.from, std::min(toLow / direction, toHigh / direction));
    part.to = std::min(part.to, std::max(toLow / direction, toHigh / direction));
  }
  return part;
}

constexpr double kLeastCosine = 0x1p-10;  // along a surface t says nothing

// Finds the crossings of the leaves that a ray may meet, and from them those of the result; both as far as they are needed.
class Crossings {
 public:
  Crossings(const Model& model, const Solid& solid, const LocalRay& ray, const Moment& moment)
      : model_(model),
        solid_(solid),
        ray_(ray),
        moment_(moment),
        rays_(model, solid, ray, moment),
        now_(solid) {}

  Crossing firstBeyond(double tMin) {
    // A few stretches, each four times as long as all before: what lies behind the hit is hardly looked at.
    constexpr std::size_t kFew = 8;  // leaves: they are all looked at
    constexpr double kShares[] = {1. / 16, 1. / 4};
    const Passage whole = passage(solid_.extent, ray_);
    if (whole.from > whole.to) return {};
    start_ = whole.from;
    if (solid_.leaves.size() > kFew && whole.to < kInfinity) {
      for (const double share : kShares) {
        const double length = share * (whole.to - whole.from);
        const Crossing found = advance(whole.from + length, whole.from + length * (1 - 0x1p-20), tMin);
        if (found.exists()) return found;
      }
    }
    return advance(whole.to, kInfinity, tMin);
  }

 private:
  // Open surfaces, and their next crossing.
  struct Sheets {
    std::uint32_t leaf = 0;
    LocalRay ray;
    std::optional<LeafCrossing> next;
  };

  // The first crossing beyond tMin that lies before `sure`, having looked up to `end`.
  Crossing advance(double end, double sure, double tMin) {
    find(end);
    const std::span<LeafCrossing> found(found_.data(), found_.size());
    for (std::size_t i = 0; i < found.size() && found[i].t <= sure; ++i) {
      if (found[i].taken) continue;
      const Crossing next = event(found, i);
      if (!next.exists()) continue;
      if (!last_.exists()) {
        last_ = next;
      } else if (next.t > last_.t) {
        if (last_.t > tMin) return last_;
        last_ = next;
      } else if (next.entering != last_.entering) {
        last_ = {};  // a film that is thinner than rounding
      }
    }
    return last_.t > tMin ? last_ : Crossing{};
  }

  // Adds the crossings of the leaves whose bounds begin until `end`, and did not begin before.
  void find(double end) {
    double limit = end * ray_.scale;
    const std::span<const std::uint32_t> order = solid_.bvh.order();
    solid_.bvh.nearest(ray_.origin, ray_.direction, std::max(begun_, start_) * ray_.scale, limit,
                       [&](std::uint32_t first, std::uint32_t count) {
                         for (std::uint32_t leaf : order.subspan(first, count)) findIn(leaf, end);
                       });
    for (Sheets& sheets : sheets_) follow(sheets, end);
    begun_ = end;
    LeafCrossing* const first = found_.data();
    std::sort(first, first + found_.size(), [](const LeafCrossing& a, const LeafCrossing& b) {
      return a.t != b.t ? a.t < b.t : a.leaf < b.leaf;
    });
  }

  void findIn(std::uint32_t leaf, double end) {
    const Solid::Leaf& at = solid_.leaves[leaf];
    const Passage part = at.endless ? Passage{} : passage(at.bounds, ray_);
    if (part.from > part.to || part.from > end || part.from <= begun_ || part.to < start_) return;
    const LocalRay ray = rays_.at(at.step);
    if (!(ray.scale > 0)) return;
    if (at.sheets != nullptr) {
      sheets_.push_back({leaf, ray, nextSheet(leaf, ray, 0)});
      begin(at, leaf, part.from, sheets_.back().next ? !sheets_.back().next->entering : false);
      return;
    }
    const PlacedObject& object = model_.store().object(solid_.steps[at.step].object);
    withShape(model_.store(), object, [&](const auto& shape) {
      begin(at, leaf, part.from, addCrossings(shape, leaf, ray, part.from > 0));
      return 0;
    });
  }

  // Adds the crossings of a shape.  Is the ray inside where its bounds begin?  `beginsOutside`: its origin is outside of them.
  template <class S>
  bool addCrossings(const S& shape, std::uint32_t leaf, const LocalRay& ray, bool beginsOutside) {
    if constexpr (Convex<S>) {
      const double in = shape.intersect(ray, -kInfinity);
      const double out = in < kNoHit ? shape.intersect(ray, in) : kNoHit;
      const double tIn = in / ray.scale, tOut = out / ray.scale;
      if (!(in < kNoHit) || tIn == tOut) return false;
      if (out < kNoHit) {
        if (tIn > 0) found_.push_back(crossing(leaf, tIn, true, 0, ray));
        if (tOut > 0) found_.push_back(crossing(leaf, tOut, false, 0, ray));
        return tIn <= 0 && tOut > 0;
      }
      if (S::solid || !(tIn > 0)) return false;  // it touches, or is behind the ray
      const std::optional<double> cosine = crossingCosine(shape.pointAt(ray, in), ray);
      if (!cosine) return false;
      found_.push_back(crossing(leaf, tIn, *cosine < 0, *cosine, ray));
      found_.back().insideAfter = false;
      return *cosine > 0;
    } else {
      const std::size_t first = found_.size();
      double last = 0;
      for (double root = shape.intersect(ray, 0); root < kNoHit; root = shape.intersect(ray, root)) {
        const double t = root / ray.scale;
        if (!(t > last)) continue;
        last = t;
        const std::optional<double> cosine = crossingCosine(shape.pointAt(ray, root), ray);
        if (!cosine) continue;
        // A ray does not leave what it can't have been in.
        if (S::solid && *cosine > 0 && beginsOutside && found_.size() == first) continue;
        found_.push_back(crossing(leaf, t, *cosine < 0, *cosine, ray));
        if (found_.size() > first + 1) found_[found_.size() - 2].insideAfter = !found_.back().entering;
      }
      if (found_.size() > first) {
        found_.back().insideAfter = S::solid && S::unbounded && found_.back().entering;
        return !found_[first].entering;
      }
      if constexpr (S::unbounded) return shape.inside(ray.origin);
      return false;
    }
  }

  // A leaf begins at t, and there the ray is inside of it already: open pieces are entered where nothing is seen.
  void begin(const Solid::Leaf& at, std::uint32_t leaf, double t, bool inside) {
    if (!inside) return;
    if (t == 0) return now_.change(at.place, true);
    LeafCrossing silent{t, 0, 1, leaf, true, true};
    silent.silent = true;
    found_.push_back(silent);
  }

  LeafCrossing crossing(std::uint32_t leaf, double t, bool entering, double cosine, const LocalRay& ray) {
    const double off = 8 * kRounding * (maxAbs(ray.origin) + t * ray.scale) + solid_.leaves[leaf].tolerance;
    worst_ = std::max(worst_, off / ray.scale);
    return {t, off / ray.scale, cosine, leaf, entering, entering};
  }

  // The error of a crossing's t: two that are not farther from each other coincide.  The cosine is found when it is asked for,
  // which is seldom: most crossings are alone.
  double slack(LeafCrossing& crossing) {
    if (crossing.cosine == 0) {
      const std::uint32_t step = solid_.leaves[crossing.leaf].step;
      const PathStep shape{solid_.steps[step].object, rays_.at(step)};
      crossing.cosine = dot(shape.ray.direction, pointAt(model_, shape, crossing.t).geometricNormal);
    }
    return crossing.error / std::max(std::abs(crossing.cosine), kLeastCosine);
  }

  std::optional<LeafCrossing> nextSheet(std::uint32_t leaf, const LocalRay& ray, double tMin) {
    for (;;) {
      const Hit hit = nearestHit(model_, *solid_.leaves[leaf].sheets, ray, moment_, tMin, kNoHit);
      if (!hit.found()) return std::nullopt;
      const std::optional<double> cosine = cosineAt(model_, hit.object, ray, moment_, hit.t);
      if (cosine) return crossing(leaf, hit.t, *cosine < 0, *cosine, ray);
      tMin = hit.t;
    }
  }

  // Adds what is crossed until `end`: each crossing when the one behind it is known.
  void follow(Sheets& sheets, double end) {
    while (sheets.next && sheets.next->t <= end) {
      found_.push_back(*sheets.next);
      sheets.next = nextSheet(sheets.leaf, sheets.ray, sheets.next->t);
      found_.back().insideAfter = sheets.next && !sheets.next->entering;
    }
  }

  // The crossing of the result, if there is one, where that of a leaf is and all that coincide with it.
  Crossing event(std::span<LeafCrossing> found, std::size_t begin) {
    if (found[begin].silent) {
      found[begin].taken = true;
      now_.change(solid_.leaves[found[begin].leaf].place, true);
      return {};
    }
    const Insides before = now_;
    InlineVector<std::size_t, 4> together;
    const double t = found[begin].t, farthest = t + 2 * worst_ / kLeastCosine;
    for (std::size_t i = begin; i < found.size() && found[i].t <= farthest; ++i) {
      LeafCrossing& crossing = found[i];
      if (crossing.taken || crossing.silent) continue;
      if (i != begin && crossing.t - t > slack(found[begin]) + slack(crossing)) continue;
      // A leaf may be crossed twice there: then one event follows the other.
      if (std::any_of(together.begin(), together.end(),
                      [&](std::size_t k) { return found[k].leaf == crossing.leaf; }))
        continue;
      crossing.taken = true;
      together.push_back(i);
      now_.change(solid_.leaves[crossing.leaf].place, crossing.entering);
    }
    Crossing result;
    if (now_.inside(0) != before.inside(0)) {
      for (std::size_t i : together) {
        const LeafCrossing& crossing = found[i];
        if ((result.exists() && crossing.leaf > result.leaf) || !turned(crossing, before)) continue;
        result = {crossing.t, crossing.leaf, now_.inside(0)};
      }
    }
    for (std::size_t i : together) {
      const LeafCrossing& crossing = found[i];
      if (crossing.insideAfter != crossing.entering)
        now_.change(solid_.leaves[crossing.leaf].place, crossing.insideAfter);
    }
    return result;
  }

  // Has everything changed from the leaf up to the result?
  bool turned(const LeafCrossing& crossing, const Insides& before) const {
    for (Solid::Place at = solid_.leaves[crossing.leaf].place; at.operation != kNone;
         at = solid_.operations[at.operation].place)
      if (now_.inside(at.operation) == before.inside(at.operation)) return false;
    return true;
  }

  const Model& model_;
  const Solid& solid_;
  const LocalRay& ray_;
  const Moment& moment_;
  LocalRays rays_;
  Insides now_;
  InlineVector<LeafCrossing, 24> found_;
  InlineVector<Sheets, 1> sheets_;
  double worst_ = 0;   // error of a crossing
  double start_ = 0;   // what ends before that is of no interest: the ray is outside of the result
  double begun_ = -1;  // what begins until here is known
  Crossing last_;      // not given out yet
};

}  // namespace

Crossing firstCrossing(const Model& model, const Solid& solid, const LocalRay& ray, const Moment& moment,
                       double tMin) {
  return Crossings(model, solid, ray, moment).firstBeyond(tMin);
}

Crossing crossingAt(const Model& model, const Solid& solid, const LocalRay& ray, const Moment& moment,
                    double t) {
  return firstCrossing(model, solid, ray, moment, std::nextafter(t, -kInfinity));
}

}  // namespace rayshade
