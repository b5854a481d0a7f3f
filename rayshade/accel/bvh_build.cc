// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/accel/bvh_build.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "rayshade/accel/margins.h"

namespace rayshade {
namespace {

float floatBelow(double x) {
  return static_cast<float>(x - (std::abs(x) * margins::kCorner + margins::kCornerLeast));
}
float floatAbove(double x) {
  return static_cast<float>(x + (std::abs(x) * margins::kCorner + margins::kCornerLeast));
}

// The box of one item, in the tree's coordinates; the fourth element is unused.
struct Piece {
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

// Nodes while their number is not known: a vector that grows is there twice.
class GrowingNodes {
 public:
  std::uint32_t add() {
    if (size_ % kPart == 0) parts_.emplace_back();
    parts_.back().emplace_back();
    return size_++;
  }
  BvhNode& operator[](std::uint32_t i) { return parts_[i / kPart][i % kPart]; }

  std::vector<BvhNode> take() {
    std::vector<BvhNode> all;
    all.reserve(size_);
    for (std::vector<BvhNode>& part : parts_) {
      all.insert(all.end(), part.begin(), part.end());
      std::vector<BvhNode>().swap(part);
    }
    return all;
  }

 private:
  static constexpr std::uint32_t kPart = 4096;
  std::vector<std::vector<BvhNode>> parts_;
  std::uint32_t size_ = 0;
};

struct Range {
  std::uint32_t first, count;
  int depth;           // below the root
  Piece box, middles;  // of the items, of the sums low + high
};

class Builder {
 public:
  Builder(std::vector<Piece> pieces, std::vector<std::uint32_t>& order)
      : pieces_(std::move(pieces)), order_(order) {}

  ChildRef build() { return build(measure(0, static_cast<std::uint32_t>(pieces_.size()), 0)); }

  // What was built.
  std::vector<BvhNode> takeNodes() {
    std::vector<Piece>().swap(pieces_);
    return nodes_.take();
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
  ChildRef build(const Range& whole) {
    if (whole.count <= kLeafItems) return leafOf(whole.first, whole.count);
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
    const std::uint32_t here = nodes_.add();
    constexpr float kNowhere = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
      for (int child = 0; child < 4; ++child) {
        nodes_[here].plane[axis][child] = child < count ? children[child].box.low[axis] : kNowhere;
        nodes_[here].plane[axis + 3][child] = child < count ? children[child].box.high[axis] : -kNowhere;
      }
    for (int child = 0; child < 4; ++child) {
      const ChildRef built = child < count ? build(children[child]) : 0;
      nodes_[here].child[child] = built;
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
  GrowingNodes nodes_;
};

}  // namespace

BvhTree buildBvh(std::span<const Bounds> items) {
  return buildBvh(items.size(), [&](std::uint32_t item) { return items[item]; });
}

BvhTree buildBvh(std::size_t items, const BoundsOf& boundsOf) {
  if (items > kMostItems) throw std::length_error("too many objects in one place");
  BvhTree tree;
  std::vector<std::uint32_t>& order = tree.order;
  order.reserve(items);
  std::vector<std::uint32_t> unbounded, empty;
  Bounds box;
  for (std::uint32_t i = 0; i < items; ++i) {
    const Bounds b = boundsOf(i);
    if (b.low.x > b.high.x || b.low.y > b.high.y || b.low.z > b.high.z) {
      empty.push_back(i);
    } else if (b.finite() && maxAbs(b.low) <= margins::kLargest && maxAbs(b.high) <= margins::kLargest) {
      order.push_back(i);
      box = join(box, b);
    } else {
      unbounded.push_back(i);
    }
  }
  tree.inTree = static_cast<std::uint32_t>(order.size());
  tree.unbounded = static_cast<std::uint32_t>(unbounded.size());
  order.insert(order.end(), unbounded.begin(), unbounded.end());
  order.insert(order.end(), empty.begin(), empty.end());
  if (tree.inTree == 0) return tree;

  tree.centre = box.centre();
  const double half = std::max(
      {maxAbs(box.high - tree.centre), maxAbs(tree.centre - box.low), maxAbs(tree.centre) * 0x1p-60});
  tree.scale = half > margins::kSmallest ? powerOfTwo(-1 - exponentOf(half))
               : half > 0                ? powerOfTwo(500)
                                         : 1.0;

  std::vector<Piece> pieces(tree.inTree);
  Piece root = Piece::empty();
  for (std::uint32_t i = 0; i < tree.inTree; ++i) {
    const Bounds item = boundsOf(order[i]);
    const Vec3 low = (item.low - tree.centre) * tree.scale, high = (item.high - tree.centre) * tree.scale;
    pieces[i] = {Float4{floatBelow(low.x), floatBelow(low.y), floatBelow(low.z), 0},
                 Float4{floatAbove(high.x), floatAbove(high.y), floatAbove(high.z), 0}};
    root.add(pieces[i]);
  }
  tree.box = {{root.low[0], root.low[1], root.low[2]}, {root.high[0], root.high[1], root.high[2]}};
  Builder builder(std::move(pieces), order);
  tree.root = builder.build();
  tree.nodes = builder.takeNodes();
  return tree;
}

}  // namespace rayshade
