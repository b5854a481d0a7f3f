// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/accel/bvh.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace rayshade {

namespace {

// 2^exponent, for exponents of normal numbers.
double powerOfTwo(int exponent) { return std::bit_cast<double>(std::uint64_t(1023 + exponent) << 52); }

// The exponent of a normal number x: 2^exponent <= x < 2^(exponent + 1).
int exponentOf(double x) { return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7ff) - 1023; }

typedef double Double2 __attribute__((vector_size(16)));

// A float below (above) x, for any x that is off by a few 2^-53 |x|: the margin is larger than that and half
// a float's last digit together; the constant serves where floats have fewer digits.
float floatBelow(double x) { return static_cast<float>(x - (std::abs(x) * 0x1.8p-24 + 0x1p-120)); }
float floatAbove(double x) { return static_cast<float>(x + (std::abs(x) * 0x1.8p-24 + 0x1p-120)); }

// Three axes as two pairs, for arithmetic on all of them at once; the fourth element is spare.
struct Axes {
  Double2 xy, z;

  Axes(Double2 a, Double2 b) : xy(a), z(b) {}
  explicit Axes(const Vec3& v) : xy{v.x, v.y}, z{v.z, v.z} {}
  Float4 rounded() const {
    return Float4{static_cast<float>(xy[0]), static_cast<float>(xy[1]), static_cast<float>(z[0]), 0};
  }
  friend Axes operator+(Axes a, Axes b) { return {a.xy + b.xy, a.z + b.z}; }
  friend Axes operator-(Axes a, Axes b) { return {a.xy - b.xy, a.z - b.z}; }
  friend Axes operator*(Axes a, Axes b) { return {a.xy * b.xy, a.z * b.z}; }
  friend Axes operator+(double s, Axes a) { return {s + a.xy, s + a.z}; }
  friend Axes operator*(double s, Axes a) { return {s * a.xy, s * a.z}; }
  friend Axes operator/(double s, Axes a) { return {s / a.xy, s / a.z}; }
};

Axes abs(Axes a) {
  const auto positive = [](Double2 x) {
    return reinterpret_cast<Double2>(reinterpret_cast<Long2>(x) & 0x7fffffffffffffff);
  };
  return {positive(a.xy), positive(a.z)};
}
// Of each axis `yes` where `chosen` is above 0, else `no`.
Axes select(Axes chosen, Axes yes, Axes no) {
  return {chosen.xy > 0.0 ? yes.xy : no.xy, chosen.z > 0.0 ? yes.z : no.z};
}

// Three lanes, each as a vector of its own.
void spread(Float4 from, Float4 (&to)[3]) {
  to[0] = splat(from[0]);
  to[1] = splat(from[1]);
  to[2] = splat(from[2]);
}

}  // namespace

// Why no box is missed.  Let the exact ray, in the tree's coordinates, be q + u d with |d|max in [1, 2) and
// u = t scale (exact: scale is a power of two), and let it touch a box at some u within [tMin, tMax] scale.
//
// 1. q' = fl(q) is off by at most 2^-53 |q|: centre and scale are exact numbers.  The root box widened by
//    slack = 2^-50 (1 + |q|) per side is entered, as computed with three roundings, before the root box
//    itself: one rounding is at most 2^-53 (|q| + |plane| + slack).  So start <= u.  A NaN (0 times infinity: a
//    direction of 0 exactly on the widened plane) is ignored by the comparisons, and the axis does not clip.
// 2. p = q' + start d is off by less than `slack` = 2^-50 (1 + |q| + |start d|).  near/farOrigin are p moved
//    forward/backward along the ray by twice the slack and 2^-22 |p|; the roundings to float on the way, of p,
//    of the margin and of the sum, take less than 2^-23 |p| and a slack of it.  So the distance to each plane
//    of each box is too small for the near planes, too large for the far ones, before rounding.
// 3. (plane - origin) * inverse has three roundings to float, less than 2^-22 together.  nearInverse is
//    shortened, farInverse lengthened by 2^-21, less one rounding.  A negative near becomes 0 by the comparison with 0; a
//    negative far keeps its sign, and is a true miss.  What underflows is far smaller than the slack.
// 4. |d| < 2^-60 on an axis (0 and -0 among them) is replaced by 2^-60: within the root box s <= 2 + 4 slack,
//    the ray moves by less than the slack on that axis; a box that it touches has near < 0 and
//    far > (slack / 2) 2^60 > s.  No factor is 0, none is infinite but the planes of unused children:
//    no NaN arises.
// 5. limit(tMax) = tMax scale - start has one rounding in double and one in float, widened by 2^-22.
//
// Hence enters <= s <= leaves for the box, and it is visited.
Bvh::Entry Bvh::enter(const Vec3& origin, const Vec3& direction, double tMin, double tMax,
                      BoxRay& ray) const {
  if (!isFinite(origin) || !isFinite(direction)) return Entry::kMissed;
  const double reach = maxAbs(direction);
  if (reach != 0 && !(reach >= kSmallest && reach <= kLargest)) return Entry::kEverything;
  const Vec3 q = (origin - centre_) * scale_;
  if (!(maxAbs(q) <= kFarthest)) return Entry::kEverything;
  const double stretch = reach != 0 ? powerOfTwo(exponentOf(reach)) : 1.0;
  const Vec3 d = direction * (1 / stretch);
  ray.scale = stretch * scale_;

  double start = tMin * ray.scale, end = tMax * ray.scale;
  const Axes q2(q), d2(d), low2(box_.low), high2(box_.high);
  const Axes exactly = 1.0 / d2, far2 = abs(q2);
  const Axes slack = 0x1p-50 * (1.0 + far2);
  const Axes toLow = (low2 - slack - q2) * exactly, toHigh = (high2 + slack - q2) * exactly;
  const Axes near = select(exactly, toLow, toHigh), far = select(exactly, toHigh, toLow);
  const auto enterSlab = [&start, &end](double from, double to) {
    start = from > start ? from : start;
    end = to < end ? to : end;
  };
  enterSlab(near.xy[0], far.xy[0]);
  enterSlab(near.xy[1], far.xy[1]);
  enterSlab(near.z[0], far.z[0]);
  if (!(start <= end)) return Entry::kMissed;
  // Infinite only for a ray that stands still, where any number will do.
  start = std::clamp(start, -kLargest, kLargest);
  ray.start = start;
  ray.setLimit(tMax);

  const Axes step = start * d2, p = q2 + step;
  const Axes margin = 0x1p-22 * abs(p) + 0x1p-49 * (1.0 + far2 + abs(step));
  const Float4 place = p.rounded(), moved = margin.rounded();
  ray.direction = d2.rounded();
  // Off the axes and the planes of the box: at least 2^-60, with its sign.
  const Axes least(
      Vec3{std::copysign(0x1p+60, d.x), std::copysign(0x1p+60, d.y), std::copysign(0x1p+60, d.z)});
  const Float4 inverse = select(abs(d2) - Axes(Vec3{0x1p-60, 0x1p-60, 0x1p-60}), exactly, least).rounded();
  const Float4 forward = inverse > Float4{} ? moved : -moved;
  spread(place + forward, ray.nearOrigin);
  spread(place - forward, ray.farOrigin);
  spread(inverse * splat(1 - 0x1p-21f), ray.nearInverse);
  spread(inverse * splat(1 + 0x1p-21f), ray.farInverse);
  ray.octant = static_cast<std::uint32_t>(std::signbit(d.x)) |
               static_cast<std::uint32_t>(std::signbit(d.y)) << 1 |
               static_cast<std::uint32_t>(std::signbit(d.z)) << 2;
  return Entry::kEntered;
}

// The box of one item, in the tree's coordinates; the fourth element is unused.
struct Bvh::Piece {
  Float4 low, high;

  void add(const Piece& p) {
    low = minimum(low, p.low);
    high = maximum(high, p.high);
  }
  static Piece empty() {
    return {splat(std::numeric_limits<float>::infinity()), splat(-std::numeric_limits<float>::infinity())};
  }
  float area() const {  // half the surface
    const Float4 size = high - low;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

struct Bvh::Range {
  std::uint32_t first, count;
  int depth;           // below the root
  Piece box, middles;  // of the items, of the sums low + high
};

class Bvh::Builder {
 public:
  Builder(std::vector<Piece> pieces, std::vector<std::uint32_t>& order, std::vector<Node>& nodes)
      : pieces_(std::move(pieces)), order_(order), nodes_(nodes) {}

  std::uint32_t build() {
    nodes_.reserve(pieces_.size() / 4 + 1);
    return build(measure(0, static_cast<std::uint32_t>(pieces_.size()), 0));
  }

 private:
  static constexpr std::uint32_t kLeafItems = 2;
  static constexpr int kBins = 16;

  Range measure(std::uint32_t first, std::uint32_t count, int depth) const {
    Range range{first, count, depth, Piece::empty(), Piece::empty()};
    for (std::uint32_t i = first; i < first + count; ++i) {
      range.box.add(pieces_[i]);
      const Float4 middle = pieces_[i].low + pieces_[i].high;
      range.middles.add({middle, middle});
    }
    return range;
  }

  // Opens the child of the largest area until there are four.
  std::uint32_t build(const Range& whole) {
    if (whole.count <= kLeafItems) return kLeaf | (whole.count - 1) << kFirstBits | whole.first;
    Range children[4] = {whole};
    int count = 1;
    while (count < 4) {
      int widest = -1;
      for (int i = 0; i < count; ++i)
        if (children[i].count > kLeafItems &&
            (widest < 0 || children[i].box.area() > children[widest].box.area()))
          widest = i;
      if (widest < 0) break;
      const Range opened = children[widest];
      const std::uint32_t low = split(opened);
      children[widest] = measure(opened.first, low, opened.depth + 1);
      children[count++] = measure(opened.first + low, opened.count - low, opened.depth + 1);
    }
    const std::uint32_t here = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    constexpr float kNowhere = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < 4; ++lane) {
        nodes_[here].plane[axis][lane] = lane < count ? children[lane].box.low[axis] : kNowhere;
        nodes_[here].plane[axis + 3][lane] = lane < count ? children[lane].box.high[axis] : -kNowhere;
      }
    for (int lane = 0; lane < 4; ++lane) {
      const std::uint32_t child = lane < count ? build(children[lane]) : 0;
      nodes_[here].child[lane] = child;
    }
    return here;
  }

  // Orders the range so that its first part, of the size returned, is one child.
  //
  // Depth: every range keeps count <= 2^(kMaxDepth - depth); it holds at the root (2^28 items), a split that
  // would break it is replaced by halves, and halves keep it.  So a range at kMaxDepth has one item: a leaf.
  std::uint32_t split(const Range& range) {
    const std::uint64_t most = std::uint64_t{1} << (kMaxDepth - range.depth - 1);
    const std::uint32_t low = splitByCost(range);
    if (low != 0 && low <= most && range.count - low <= most) return low;
    return range.count / 2;
  }

  // Least area times items over both sides, among kBins - 1 planes per axis; 0 when all middles coincide.
  std::uint32_t splitByCost(const Range& range) {
    const Float4 extent = range.middles.high - range.middles.low;
    Float4 toBin{};
    for (int axis = 0; axis < 3; ++axis)
      if (extent[axis] > 0x1p-100f) toBin[axis] = kBins / extent[axis];
    const auto binsOf = [&](const Piece& piece) {
      const Float4 at = (piece.low + piece.high - range.middles.low) * toBin;
      return __builtin_convertvector(minimum(at, splat(kBins - 1)), Int4);
    };

    Piece boxes[3][kBins];
    std::uint32_t counts[3][kBins] = {};
    for (auto& axis : boxes) std::fill(std::begin(axis), std::end(axis), Piece::empty());
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      const Int4 bins = binsOf(pieces_[i]);
      for (int axis = 0; axis < 3; ++axis) {
        boxes[axis][bins[axis]].add(pieces_[i]);
        ++counts[axis][bins[axis]];
      }
    }

    float bestCost = std::numeric_limits<float>::infinity();
    int bestAxis = -1, bestBin = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (toBin[axis] == 0) continue;
      float above[kBins];  // cost of the side above the plane below a bin
      Piece side = Piece::empty();
      std::uint32_t count = 0;
      for (int bin = kBins - 1; bin > 0; --bin) {
        side.add(boxes[axis][bin]);
        count += counts[axis][bin];
        above[bin] = count == 0 ? 0 : side.area() * static_cast<float>(count);
      }
      side = Piece::empty();
      count = 0;
      for (int bin = 1; bin < kBins; ++bin) {
        side.add(boxes[axis][bin - 1]);
        count += counts[axis][bin - 1];
        if (count == 0 || count == range.count) continue;
        const float cost = side.area() * static_cast<float>(count) + above[bin];
        if (cost < bestCost) {
          bestCost = cost;
          bestAxis = axis;
          bestBin = bin;
        }
      }
    }
    if (bestAxis < 0) return 0;

    std::uint32_t low = range.first, high = range.first + range.count;
    while (low < high) {
      if (binsOf(pieces_[low])[bestAxis] < bestBin) {
        ++low;
      } else {
        --high;
        std::swap(pieces_[low], pieces_[high]);
        std::swap(order_[low], order_[high]);
      }
    }
    return low - range.first;
  }

  std::vector<Piece> pieces_;
  std::vector<std::uint32_t>& order_;
  std::vector<Node>& nodes_;
};

Bvh::Bvh(std::span<const Bounds> items) {
  if (items.size() > kMaxItems) throw std::length_error("too many objects in one place");
  enum Kind { kInTree, kUnbounded, kEmpty };
  const auto kind = [&](std::uint32_t i) {
    const Bounds& b = items[i];
    if (b.low.x > b.high.x || b.low.y > b.high.y || b.low.z > b.high.z) return kEmpty;
    return b.finite() && maxAbs(b.low) <= kLargest && maxAbs(b.high) <= kLargest ? kInTree : kUnbounded;
  };
  order_.resize(items.size());
  std::iota(order_.begin(), order_.end(), 0u);
  const auto unbounded = std::stable_partition(order_.begin(), order_.end(),
                                               [&](std::uint32_t i) { return kind(i) == kInTree; });
  const auto empty =
      std::stable_partition(unbounded, order_.end(), [&](std::uint32_t i) { return kind(i) == kUnbounded; });
  inTree_ = static_cast<std::uint32_t>(unbounded - order_.begin());
  unbounded_ = static_cast<std::uint32_t>(empty - unbounded);
  if (inTree_ == 0) return;

  Bounds box;
  for (auto i = order_.begin(); i != unbounded; ++i) box = join(box, items[*i]);
  centre_ = box.centre();
  const double half =
      std::max({maxAbs(box.high - centre_), maxAbs(centre_ - box.low), maxAbs(centre_) * 0x1p-60});
  scale_ = half > kSmallest ? powerOfTwo(-1 - exponentOf(half)) : half > 0 ? powerOfTwo(500) : 1.0;

  std::vector<Piece> pieces(inTree_);
  Piece root = Piece::empty();
  for (std::uint32_t i = 0; i < inTree_; ++i) {
    const Bounds& item = items[order_[i]];
    const Vec3 low = (item.low - centre_) * scale_, high = (item.high - centre_) * scale_;
    pieces[i] = {Float4{floatBelow(low.x), floatBelow(low.y), floatBelow(low.z), 0},
                 Float4{floatAbove(high.x), floatAbove(high.y), floatAbove(high.z), 0}};
    root.add(pieces[i]);
  }
  box_ = {{root.low[0], root.low[1], root.low[2]}, {root.high[0], root.high[1], root.high[2]}};
  root_ = Builder(std::move(pieces), order_, nodes_).build();
  nodes_.shrink_to_fit();
}

std::size_t Bvh::bytes() const {
  return sizeof *this + nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::uint32_t);
}

}  // namespace rayshade
