// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/accel/bvh_build.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "rayshade/accel/margins.h"
#include "rayshade/base/crew.h"

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
    if (size_ % kPart == 0) parts_.emplace_back().reserve(kPart);
    parts_.back().emplace_back();
    return size_++;
  }
  BvhNode& operator[](std::uint32_t i) { return parts_[i / kPart][i % kPart]; }
  std::uint32_t size() const { return size_; }

  // Puts them at the end of a list, where they have other numbers, and forgets them.
  void moveTo(std::vector<BvhNode>& all) {
    const auto first = static_cast<std::uint32_t>(all.size());
    for (std::vector<BvhNode>& part : parts_) {
      for (BvhNode& node : part) {
        for (ChildRef& child : node.child)
          if (!isLeaf(child)) child += first;
        all.push_back(node);
      }
      std::vector<BvhNode>().swap(part);
    }
  }

 private:
  static constexpr std::uint32_t kPart = 256;  // small: every job has one that is not full
  std::vector<std::vector<BvhNode>> parts_;
  std::uint32_t size_ = 0;
};

struct Range {
  std::uint32_t first = 0, count = 0;
  int depth = 0;                                         // below the root
  Piece box = Piece::empty(), middles = Piece::empty();  // of the items, of the sums low + high

  void add(const Piece& piece) {
    ++count;
    box.add(piece);
    const Float4 middle = piece.low + piece.high;
    middles.add({middle, middle});
  }
};

// Calls use(i) for i = 0 ... count - 1.
template <class Use>
void forEach(Crew& crew, std::size_t count, const Use& use) {
  for (std::size_t i = 0; i < count; ++i) crew.give([&use, i](unsigned) { use(i); });
  while (crew.left() > 0)
    if (!crew.work()) crew.waitForOne();
  crew.rethrow();
}

class Builder {
 public:
  Builder(std::vector<Piece> pieces, std::vector<std::uint32_t>& order)
      : pieces_(std::move(pieces)), order_(order) {}

  // The top of the tree is built first, down to ranges of which each is a job.
  void build(Crew& crew, BvhTree& tree) {
    const Range all = measure(0, static_cast<std::uint32_t>(pieces_.size()), 0);
    jobItems_ = std::max(kLeastJob, all.count / kJobs);
    tree.root = build(all, top_, all.count > jobItems_ ? &jobs_ : nullptr);
    forEach(crew, jobs_.size(),
            [&](std::size_t i) { jobs_[i].root = build(jobs_[i].range, jobs_[i].nodes, nullptr); });
    std::vector<Piece>().swap(pieces_);
    std::size_t nodes = top_.size();
    for (const Job& job : jobs_) nodes += job.nodes.size();
    tree.nodes.reserve(nodes);
    top_.moveTo(tree.nodes);
    for (Job& job : jobs_) {
      const auto first = static_cast<std::uint32_t>(tree.nodes.size());
      tree.nodes[job.node].child[job.child] = isLeaf(job.root) ? job.root : job.root + first;
      job.nodes.moveTo(tree.nodes);
    }
  }

 private:
  // A range below the top of the tree.
  struct Job {
    Range range;
    std::uint32_t node;  // of the top, whose child it becomes
    int child;
    GrowingNodes nodes{};
    ChildRef root{};
  };
  static constexpr std::uint32_t kLeastJob = 1u << 14, kJobs = 32;  // items; so many jobs at least
  static constexpr std::uint32_t kLeafItems = 2;
  static constexpr int kBins = 16;
  static constexpr std::uint32_t kFew = 12;  // items that are sorted instead

  Range measure(std::uint32_t first, std::uint32_t count, int depth) const {
    Range range{first, 0, depth};
    for (std::uint32_t i = first; i < first + count; ++i) range.add(pieces_[i]);
    return range;
  }

  // Opens the child of the largest area until there are four.  `jobs`: where small ranges are left for later.
  ChildRef build(const Range& whole, GrowingNodes& nodes, std::vector<Job>* jobs) {
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
      split(opened, children[widest], children[count++]);
    }
    const std::uint32_t here = nodes.add();
    constexpr float kNowhere = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
      for (int child = 0; child < 4; ++child) {
        nodes[here].plane[axis][child] = child < count ? children[child].box.low[axis] : kNowhere;
        nodes[here].plane[axis + 3][child] = child < count ? children[child].box.high[axis] : -kNowhere;
      }
    for (int child = 0; child < 4; ++child) {
      if (child < count && jobs != nullptr && children[child].count <= jobItems_) {
        jobs->push_back({children[child], here, child});
        continue;
      }
      const ChildRef built = child < count ? build(children[child], nodes, jobs) : 0;
      nodes[here].child[child] = built;
    }
    return here;
  }

  // Orders the range so that its first part is one child, the rest the other.
  //
  // Depth: every range keeps count <= 2^(kMaxDepth - depth); it holds at the root (2^28 items), a split that
  // would break it is replaced by halves, and halves keep it.  So a range at kMaxDepth has one item: a leaf.
  void split(const Range& range, Range& low, Range& high) {
    const std::uint64_t most = std::uint64_t{1} << (kMaxDepth - range.depth - 1);
    low = {range.first, 0, range.depth + 1};
    high = {range.first, 0, range.depth + 1};
    if (range.count <= kFew) {
      splitFew(range, low, high);
    } else {
      splitByCost(range, low, high);
    }
    high.first += low.count;
    if (low.count != 0 && low.count <= most && high.count <= most) return;
    const std::uint32_t half = range.count / 2;
    low = measure(range.first, half, range.depth + 1);
    high = measure(range.first + half, range.count - half, range.depth + 1);
  }

  // Least area times items over both sides, among all planes between two middles.
  void splitFew(const Range& range, Range& low, Range& high) {
    std::array<Piece, kFew> pieces;
    std::array<std::uint32_t, kFew> items;
    std::array<Float4, kFew> middles;
    for (std::uint32_t i = 0; i < range.count; ++i) {
      pieces[i] = pieces_[range.first + i];
      items[i] = order_[range.first + i];
      middles[i] = pieces[i].low + pieces[i].high;
    }
    std::array<std::uint32_t, kFew> best{};
    std::uint32_t bestCount = 0;
    float bestCost = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      std::array<std::uint32_t, kFew> sorted;
      for (std::uint32_t i = 0; i < range.count; ++i) {
        std::uint32_t at = i;
        for (; at > 0 && middles[sorted[at - 1]][axis] > middles[i][axis]; --at) sorted[at] = sorted[at - 1];
        sorted[at] = i;
      }
      std::array<float, kFew> above;  // cost of the items from one on
      Piece side = Piece::empty();
      for (std::uint32_t i = range.count - 1; i > 0; --i) {
        side.add(pieces[sorted[i]]);
        above[i] = side.area() * static_cast<float>(range.count - i);
      }
      side = Piece::empty();
      for (std::uint32_t i = 1; i < range.count; ++i) {
        side.add(pieces[sorted[i - 1]]);
        const float cost = side.area() * static_cast<float>(i) + above[i];
        if (cost < bestCost) {
          bestCost = cost;
          bestCount = i;
          best = sorted;
        }
      }
    }
    if (bestCount == 0) return;
    for (std::uint32_t i = 0; i < range.count; ++i) {
      pieces_[range.first + i] = pieces[best[i]];
      order_[range.first + i] = items[best[i]];
      (i < bestCount ? low : high).add(pieces[best[i]]);
    }
  }

  // The same among kBins - 1 planes per axis; nothing when all middles coincide.
  void splitByCost(const Range& range, Range& lower, Range& upper) {
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
    if (bestAxis < 0) return;

    std::uint32_t low = range.first, high = range.first + range.count;
    while (low < high) {
      if (binsOf(pieces_[low])[bestAxis] < bestBin) {
        lower.add(pieces_[low++]);
      } else {
        upper.add(pieces_[low]);
        --high;
        std::swap(pieces_[low], pieces_[high]);
        std::swap(order_[low], order_[high]);
      }
    }
  }

  std::vector<Piece> pieces_;
  std::vector<std::uint32_t>& order_;
  GrowingNodes top_;
  std::vector<Job> jobs_;
  std::uint32_t jobItems_ = 0;
};

}  // namespace

BvhTree buildBvh(std::span<const Bounds> items) {
  return buildBvh(items.size(), [&](std::uint32_t item) { return items[item]; });
}

BvhTree buildBvh(std::size_t items, const BoundsOf& boundsOf, unsigned threads) {
  if (items > kMostItems) throw std::length_error("too many objects in one place");
  constexpr std::size_t kWorthThreads = std::size_t{1} << 15;
  Crew crew(items < kWorthThreads ? 1 : threads);
  BvhTree tree;
  std::vector<std::uint32_t>& order = tree.order;
  order.reserve(items);
  // Parts of all items, one after the other.
  constexpr std::size_t kPart = std::size_t{1} << 14;
  struct Part {
    std::vector<std::uint32_t> unbounded, empty;
    Bounds box;
    Piece root = Piece::empty();
  };
  const auto forEachPart = [&](std::size_t count, const auto& use) {
    forEach(crew, (count + kPart - 1) / kPart, [&](std::size_t part) {
      use(part, static_cast<std::uint32_t>(part * kPart),
          static_cast<std::uint32_t>(std::min(count, (part + 1) * kPart)));
    });
  };
  std::vector<Part> parts((items + kPart - 1) / kPart);
  forEachPart(items, [&](std::size_t part, std::uint32_t first, std::uint32_t end) {
    Part own;
    for (std::uint32_t i = first; i < end; ++i) {
      const Bounds b = boundsOf(i);
      if (b.low.x > b.high.x || b.low.y > b.high.y || b.low.z > b.high.z) {
        own.empty.push_back(i);
      } else if (b.finite() && maxAbs(b.low) <= margins::kLargest && maxAbs(b.high) <= margins::kLargest) {
        own.box = join(own.box, b);
      } else {
        own.unbounded.push_back(i);
      }
    }
    parts[part] = std::move(own);
  });
  std::vector<std::uint32_t> unbounded, empty;
  Bounds box;
  for (const Part& part : parts) {
    unbounded.insert(unbounded.end(), part.unbounded.begin(), part.unbounded.end());
    empty.insert(empty.end(), part.empty.begin(), part.empty.end());
    box = join(box, part.box);
  }
  std::size_t nextUnbounded = 0, nextEmpty = 0;
  for (std::uint32_t i = 0; i < items; ++i) {
    if (nextUnbounded < unbounded.size() && unbounded[nextUnbounded] == i) {
      ++nextUnbounded;
    } else if (nextEmpty < empty.size() && empty[nextEmpty] == i) {
      ++nextEmpty;
    } else {
      order.push_back(i);
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
  forEachPart(tree.inTree, [&](std::size_t part, std::uint32_t first, std::uint32_t end) {
    Piece own = Piece::empty();
    for (std::uint32_t i = first; i < end; ++i) {
      const Bounds item = boundsOf(order[i]);
      const Vec3 low = (item.low - tree.centre) * tree.scale, high = (item.high - tree.centre) * tree.scale;
      pieces[i] = {Float4{floatBelow(low.x), floatBelow(low.y), floatBelow(low.z), 0},
                   Float4{floatAbove(high.x), floatAbove(high.y), floatAbove(high.z), 0}};
      own.add(pieces[i]);
    }
    parts[part].root = own;
  });
  Piece root = Piece::empty();
  for (const Part& part : parts) root.add(part.root);
  tree.box = {{root.low[0], root.low[1], root.low[2]}, {root.high[0], root.high[1], root.high[2]}};
  Builder(std::move(pieces), order).build(crew, tree);
  return tree;
}

}  // namespace rayshade
