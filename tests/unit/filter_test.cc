// The pixel filter and the cutting out of the window.
//
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/sampling/filter.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace rayshade {
namespace {

TEST(Filter, BoxWeighsAllCellsTheSame) {
  for (std::int32_t side = 1; side <= kMaxSamplesPerSide; ++side) {
    const auto weights = filterWeights({false, 1.5}, side);
    ASSERT_EQ(weights.size(), static_cast<std::size_t>(side * side));
    for (double weight : weights) EXPECT_DOUBLE_EQ(weight, 1.0 / (side * side));
  }
}

TEST(Filter, GaussIsOneStandardDeviationPerPixel) {
  // Width 1.8, 3 x 3 cells: centres at -0.6, 0, 0.6 pixels.
  const double far = std::exp(-0.36), near = std::exp(-0.18), total = 1 + 4 * near + 4 * far;
  const auto weights = filterWeights({true, 1.8}, 3);
  const double expected[] = {far, near, far, near, 1, near, far, near, far};
  for (std::size_t cell = 0; cell < 9; ++cell) EXPECT_NEAR(weights[cell], expected[cell] / total, 1e-15);
}

TEST(Filter, TotalIsOne) {
  const double widths[] = {0, 1e-300, 1, 1.8, 100, 1e300, std::numeric_limits<double>::quiet_NaN()};
  for (double width : widths)
    for (bool gaussian : {false, true})
      for (std::int32_t side = 1; side <= kMaxSamplesPerSide; ++side) {
        const auto weights = filterWeights({gaussian, width}, side);
        EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-13) << width << " " << side;
      }
}

TEST(PixelArea, IsTheScreenUnlessSaidOtherwise) {
  PictureSpec spec;
  spec.width = 300;
  spec.height = 200;
  EXPECT_EQ(pixelArea(spec), (PixelArea{0, 0, 300, 200}));
}

TEST(PixelArea, WindowIsInclusive) {
  PictureSpec spec;
  spec.window = {10, 19, 20, 20};
  EXPECT_EQ(pixelArea(spec), (PixelArea{10, 20, 10, 1}));
}

TEST(PixelArea, CropIsAShareOfTheWindow) {
  PictureSpec spec;
  spec.window = {100, 200, 0, 10};
  spec.crop = {0.25, 0.5, 0.5, 1};
  EXPECT_EQ(pixelArea(spec), (PixelArea{125, 5, 26, 6}));
  spec.crop = {0.5, 0.25, 1, 0.5};  // the other way round: the same
  EXPECT_EQ(pixelArea(spec), (PixelArea{125, 5, 26, 6}));
  spec.crop = {-3, 7, std::numeric_limits<double>::quiet_NaN(), 2};  // cut off at the window
  EXPECT_EQ(pixelArea(spec), (PixelArea{100, 0, 101, 11}));
}

TEST(PixelArea, RefusesWhatIsNotOnTheScreen) {
  PictureSpec spec;
  for (auto window : {std::array{-1, 5, 0, 5}, {0, 512, 0, 5}, {0, 5, 0, 512}, {6, 5, 0, 5}, {0, 5, 6, 5}}) {
    spec.window = window;
    EXPECT_FALSE(pixelArea(spec));
  }
  spec.window.reset();
  for (auto [width, height] : {std::pair{0, 5}, {5, 0}, {-1, 5}, {5, kMaxPictureSide + 1}}) {
    spec.width = width;
    spec.height = height;
    EXPECT_FALSE(pixelArea(spec));
  }
}

}  // namespace
}  // namespace rayshade
