// The cells that a tile asks for are those that its rays may touch.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "pvm/trace/tiles.h"
#include "rayshade/language/parser.h"
#include "rayshade/space/walk.h"

namespace rayshade {
namespace {

TEST(TileCells, AreTouchedByTheRaysOfTheTileOnly) {
  const BinTree tree = buildBinTree({{-2, -2, -2}, {2, 2, 2}}, {1, 512});
  SceneStore store;
  for (const std::string filter : {"", "gauss 1.8 ", "box 3 "}) {
    SCOPED_TRACE(filter);
    const SceneHead head = parseSceneText("screen 64 64 sample 4 eyep 1 -9 3 lookp 0 0 0 fov 30 filter " +
                                              (filter.empty() ? std::string("box 1 ") : filter),
                                          "text", {}, store);
    FrameRequest request;
    request.view = *viewOf(head.camera, head.picture);
    request.picture = head.picture;
    const SamplingRules rules = samplingRules(request.picture, 0, 0);
    std::size_t listed = 0, touched = 0;
    for (const Tile& tile : {Tile{0, 0, 8, 8}, Tile{24, 32, 8, 8}, Tile{31, 31, 1, 1}, Tile{40, 20, 16, 4}}) {
      const std::vector<CellId> cells = cellsOf(tree, request, rules, tile, 0);
      std::vector<CellId> met;
      for (std::int32_t y = tile.y; y < tile.y + tile.height; ++y)
        for (std::int32_t x = tile.x; x < tile.x + tile.width; ++x)
          for (std::int32_t cell = 0; cell < 16; ++cell) {
            const Ray ray = primaryRay(request.view, samplePosition(request.picture, 0, 0, {x, y, cell}), 0);
            CellWalk walk(tree, ray.origin, ray.direction);
            for (WalkStep<CellId> step; walk.next(step);) {
              EXPECT_NE(std::find(cells.begin(), cells.end(), step.where), cells.end());
              if (std::find(met.begin(), met.end(), step.where) == met.end()) met.push_back(step.where);
            }
          }
      listed += cells.size();
      touched += met.size();
    }
    EXPECT_LT(listed, 1.5 * static_cast<double>(touched));
  }
}

}  // namespace
}  // namespace rayshade
