// CSG against point membership: between two crossings of any leaf a point is inside of the result or not, as the Boolean of its
// being inside of the leaves says.  Random trees of all solids, with transforms, on a lattice on which faces coincide.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/intersect/csg.h"

#include <gtest/gtest.h>

#include "tests/support/number_text.h"
#include "tests/support/seeded_random.h"
#include "tests/support/text_model.h"

namespace rayshade {
namespace {

// A tree, as a text and as a set of points.
class Tree {
 public:
  virtual ~Tree() = default;
  // In the space around it; nothing: so near to a surface that roundings decide.
  std::optional<bool> inside(Vec3 p) const { return insideHere(mapPoint(map.inverse, p)); }
  // `named`: what is in it gets names, which are written to `names`.
  std::string written(bool named, std::string& names) const {
    std::string here = writtenHere(named, names);
    if (named && mayBeNamed) {
      const std::string name = "n" + std::to_string(names.size());
      names += "name " + name + " " + here + "\n";
      here = "object " + name;
    }
    return here + transforms + "\n";
  }

  void transform(Random& random) {
    const Vec3 lattice{0.25 * random.integer(-4, 4), 0.25 * random.integer(-4, 4),
                       0.25 * random.integer(-4, 4)};
    switch (random.below(4)) {
      case 0:
        append(translation(lattice), " translate" + text(lattice));
        break;
      case 1: {
        const double angle = random.oneIn(2) ? 90 * random.integer(1, 3) : random.real(0, 360);
        const Vec3 axis = random.pick({Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 2, -1}});
        append(rotation(axis, angle), " rotate" + text(axis) + text(angle));
        break;
      }
      case 2: {
        const Vec3 by{random.pick({0.5, 1.0, 2.0, -1.0}), random.pick({0.5, 1.0, 1.5}),
                      random.pick({0.75, 1.0, -1.0})};
        append(*scaling(by), " scale" + text(by));
        break;
      }
      default: {  // far away and back
        const Vec3 far = random.point(-1e5, 1e5);
        append(then(then(translation(far), rotation({0, 0, 1}, 90)), inverted(translation(far))),
               " translate" + text(far) + " rotate 0 0 1 90 translate" + text(-far));
        const Affine back = translation(far - mapPoint(rotation({0, 0, 1}, 90).forward, far));
        append(back, " translate" + text(back.forward.origin));
      }
    }
  }

  Affine map;
  std::string transforms;
  bool mayBeNamed = false, isCsg = false;

 private:
  void append(const Affine& next, const std::string& words) {
    map = then(map, next);
    transforms += words;
  }
  virtual std::optional<bool> insideHere(Vec3 p) const = 0;
  virtual std::string writtenHere(bool named, std::string& names) const = 0;
};

constexpr double kNear = 1e-7;
std::optional<bool> belowZero(double distance) {
  if (std::abs(distance) < kNear) return std::nullopt;
  return distance < 0;
}

class Leaf : public Tree {
 public:
  explicit Leaf(Random& random)
      : kind_(random.below(6u)), at_(lattice(random)), size_(0.25 * (2 + random.below(5))) {}
  static Vec3 lattice(Random& random) {
    return {0.25 * random.integer(-4, 4), 0.25 * random.integer(-4, 4), 0.25 * random.integer(-4, 4)};
  }

 private:
  std::optional<bool> insideHere(Vec3 p) const override {
    const Vec3 q = p - at_;
    const double round = std::hypot(q.x, q.y);
    switch (kind_) {
      case 0:
      case 1:
        return belowZero(std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}) - size_);
      case 2:
        return belowZero(length(q) - size_);
      case 3:
        return belowZero(std::hypot(round - size_, q.z) - size_ / 4);
      case 4:  // with caps
        return belowZero(std::max({round - size_, -q.z, q.z - 1}));
      default:
        return belowZero(q.z);
    }
  }
  std::string writtenHere(bool, std::string&) const override {
    const Vec3 s{size_, size_, size_}, top = at_ + Vec3{0, 0, 1};
    switch (kind_) {
      case 0:
      case 1:
        return "box" + text(at_ - s) + text(at_ + s);
      case 2:
        return "sphere" + text(size_) + text(at_);
      case 3:
        return "torus" + text(size_) + text(size_ / 4) + text(at_) + " 0 0 1";
      case 4:
        // In a box: a list in a list is dissolved, and what touches there would be one solid.
        return "intersect list cylinder" + text(size_) + text(at_) + text(top) + " disc" + text(size_) +
               text(top) + " 0 0 1 disc" + text(size_) + text(at_) + " 0 0 -1 end box" + text(at_ - s * 2) +
               text(top + s) + " end";
      default:
        return "plane" + text(at_) + " 0 0 1";
    }
  }

  std::uint32_t kind_;
  Vec3 at_;
  double size_;
};

class Operation : public Tree {
 public:
  Operation(Random& random, int depth) : kind_(random.below(4u)) {
    mayBeNamed = true;
    isCsg = kind_ != 3;
    const int count = kind_ == 3 ? 1 + random.below(3) : random.oneIn(4) ? 2 + random.below(4) : 2;
    for (int i = 0; i < count; ++i) operands_.push_back(any(random, depth - 1));
  }

  static std::unique_ptr<Tree> any(Random& random, int depth) {
    std::unique_ptr<Tree> tree;
    if (depth <= 0 || random.oneIn(3)) {
      tree = std::make_unique<Leaf>(random);
    } else {
      tree = std::make_unique<Operation>(random, depth);
    }
    for (int i = random.oneIn(2) ? random.below(3) : 0; i > 0; --i) tree->transform(random);
    return tree;
  }

 private:
  std::optional<bool> insideHere(Vec3 p) const override {
    std::optional<bool> result = operands_[0]->inside(p);
    for (std::size_t i = 1; i < operands_.size() && result; ++i) {
      const std::optional<bool> next = operands_[i]->inside(p);
      if (!next) return next;
      result = kind_ == 1 ? *result && *next : kind_ == 2 ? *result && !*next : *result || *next;
    }
    return result;
  }
  std::string writtenHere(bool named, std::string& names) const override {
    static const std::string kWords[] = {"union\n", "intersect\n", "difference\n", "list\n"};
    std::string all = kWords[kind_];
    for (const auto& operand : operands_) all += operand->written(named, names);
    return all + "end";
  }

  std::uint32_t kind_;
  std::vector<std::unique_ptr<Tree>> operands_;
};

struct Crossed {
  double t = 0;
  bool entering = true;
  BodyKind shape{};
};

// A world with all that a ray crosses in it.
struct World : TextModel {
  using TextModel::TextModel;

  std::vector<Crossed> crossings(const Ray& ray) const {
    std::vector<Crossed> all;
    for (double t = 0;;) {
      const Hit hit = nearestHit(model, region, ray, t, kInfinity);
      if (!hit.found() || hit.t > 1e3) return all;  // far away rounding decides
      const HitPath path = pathTo(model, ray, hit);
      t = hit.t;
      all.push_back({t, path.entering.value_or(true), model.store().object(path.steps.back().object).kind});
    }
  }
};

Ray randomRay(Random& random) {
  Ray ray;
  ray.origin = random.oneIn(3) ? random.point(-1, 1) : 6.0 * random.direction();
  ray.direction = normalize(random.point(-1, 1) - ray.origin);
  if (random.oneIn(
          4)) {  // square to many faces, but not in any: a ray in a face, or along a rim, is in no set of points
    ray.origin = 0.25 * random.lattice(-4, 4) + Vec3{0.0031, 0.0017, -7.3};
    ray.direction = {0, 0, 1};
  }
  return ray;
}

std::string listed(const std::vector<Crossed>& crossings) {
  std::string all;
  for (const Crossed& c : crossings) all += text(c.t) + (c.entering ? " in" : " out");
  return all;
}

// The same crossings of the same shapes; t may differ by roundings: a list that has no name is dissolved, its transforms are
// multiplied with those of its members.
bool same(const std::vector<Crossed>& a, const std::vector<Crossed>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Crossed& x, const Crossed& y) {
    return std::abs(x.t - y.t) < 1e-7 && x.entering == y.entering && x.shape == y.shape;
  });
}

TEST(Csg, RandomTreesAreTheBooleanOfTheirLeaves) {
  int crossings = 0, judged = 0;
  for (std::uint64_t seed = 0; seed < seedCount(1000); ++seed) {
    SeededRandom random(seed);
    std::unique_ptr<Tree> tree;
    do {
      tree = Operation::any(random, random.integer(1, 5));
    } while (!tree->isCsg);
    std::string names, none;
    const std::string inline_ = tree->written(false, none), topNamed = tree->written(true, names);
    const World plain(inline_), named(names + topNamed),
        instanced("name all list\n" + inline_ + "end\nobject all");
    for (int i = 0; i < 20; ++i) {
      const Ray ray = randomRay(random);
      const std::vector<Crossed> result = plain.crossings(ray), withNames = named.crossings(ray);
      ASSERT_TRUE(same(result, withNames)) << listed(result) << "\n"
                                           << listed(withNames) << "\n"
                                           << inline_ << names << topNamed;
      ASSERT_TRUE(same(result, instanced.crossings(ray))) << inline_;
      crossings += static_cast<int>(result.size());
      // Between two crossings, and in small steps in between.
      std::vector<double> ends{0};
      for (const Crossed& c : result) ends.push_back(c.t);
      ends.push_back(ends.back() + 5);
      std::optional<bool> inside;  // if nothing is crossed it may be anywhere, but must stay there
      if (!result.empty()) inside = !result[0].entering;
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        if (k > 0) inside = result[k - 1].entering;
        for (int step = 1; step < 24; ++step) {
          const double t = ends[k] + (ends[k + 1] - ends[k]) * step / 24;
          const std::optional<bool> truth = tree->inside(ray.origin + t * ray.direction);
          if (!truth || std::min(t - ends[k], ends[k + 1] - t) < 1e-6) continue;
          ++judged;
          if (!inside) inside = truth;
          ASSERT_EQ(*inside, *truth) << "ray " << i << " from" << text(ray.origin) << " towards"
                                     << text(ray.direction) << ": t " << t << ", crossings " << listed(result)
                                     << "\n"
                                     << inline_;
        }
      }
    }
  }
  EXPECT_GT(crossings, static_cast<int>(10 * seedCount(1000)));
  EXPECT_GT(judged, static_cast<int>(100 * seedCount(1000)));
}

}  // namespace
}  // namespace rayshade
