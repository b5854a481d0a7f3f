// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/tiles.h"

#include <map>

#include "rayshade/space/walk.h"

namespace rayshade {

std::vector<CellId> cellsOf(const BinTree& tree, const View& view, const std::vector<Ray>& rays,
                            const std::vector<SamplePosition>& positions) {
  if (view.lensRight == Vec3{} && view.lensUp == Vec3{}) {
    double u0 = positions[0].u, u1 = u0, v0 = positions[0].v, v1 = v0;
    for (const SamplePosition& p : positions) {
      u0 = std::min(u0, p.u);
      u1 = std::max(u1, p.u);
      v0 = std::min(v0, p.v);
      v1 = std::max(v1, p.v);
    }
    // A little wider: a pyramid of one ray is none.
    constexpr double kMargin = 1e-3;  // pixels
    auto corner = [&](double u, double v) { return view.first + u * view.right + v * view.down; };
    return clipList(
        tree, pyramidOf(view.eye, {corner(u0 - kMargin, v0 - kMargin), corner(u1 + kMargin, v0 - kMargin),
                                   corner(u1 + kMargin, v1 + kMargin), corner(u0 - kMargin, v1 + kMargin)}));
  }
  std::map<std::uint32_t, double> nearest;  // by cell: where the first ray enters it
  for (const Ray& ray : rays) {
    CellWalk walk(tree, ray.origin, ray.direction);
    WalkStep<CellId> step;
    while (walk.next(step)) {
      const auto [at, isNew] = nearest.try_emplace(static_cast<std::uint32_t>(step.where), step.tEnter);
      if (!isNew) at->second = std::min(at->second, step.tEnter);
    }
  }
  std::vector<std::pair<double, std::uint32_t>> sorted;
  for (const auto& [cell, t] : nearest) sorted.emplace_back(t, cell);
  std::sort(sorted.begin(), sorted.end());
  std::vector<CellId> cells;
  for (const auto& [t, cell] : sorted) cells.push_back(CellId{cell});
  return cells;
}

}  // namespace rayshade
