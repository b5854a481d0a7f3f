// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/support/pixels.h"
#include "tests/support/texture_subjects.h"

namespace rayshade {
namespace {

ImageTexture textureOf(std::int32_t width, std::int32_t height, std::int32_t channels, const Pixels& bytes) {
  ImageTexture texture;
  texture.image = std::make_shared<const Image>(imageOfPixels(width, height, channels, bytes));
  return texture;
}

// 0 51 / 102 255
ImageTexture grayTexture() { return textureOf(2, 2, 1, {0, 51, 102, 255}); }

double lookedUp(const ImageTexture& texture, double u, double v) {
  TextureHit hit = hitAtUv(u, v);
  texture.apply(hit);
  return hit.surface.diffuse.g;
}

TEST(ImageTexture, FirstRowIsAtTheBottomAndItRepeats) {
  const ImageTexture texture = grayTexture();
  EXPECT_EQ(lookedUp(texture, 0.1, 0.1), 0);
  EXPECT_EQ(lookedUp(texture, 0.9, 0.1), 0.2);
  EXPECT_EQ(lookedUp(texture, 0.1, 0.9), 0.4);
  EXPECT_EQ(lookedUp(texture, 7.9, -3.1), 1);
}

TEST(ImageTexture, EveryCoordinateFindsAPixel) {
  const ImageTexture texture = grayTexture();
  for (double x : {0.0, 1.0, -1e-20, 1e300, -1e300, double{kInfinity}, std::nan("")})
    EXPECT_TRUE(std::isfinite(lookedUp(texture, x, x))) << x;
}

TEST(ImageTexture, ScalesSpecularTooButNotBody) {
  TextureHit hit = hitAtUv(0.1, 0.9);
  grayTexture().apply(hit);
  EXPECT_EQ(hit.surface.specular.r, 0.4);
  EXPECT_EQ(hit.surface.ambient.r, 0.4);
  EXPECT_EQ(hit.surface.body, kWhite);
}

TEST(ImageTexture, SmoothInterpolatesFromTheCornerAndWraps) {
  ImageTexture texture = grayTexture();
  texture.smooth = true;
  EXPECT_NEAR(lookedUp(texture, 0, 0), 0, kClose);
  EXPECT_NEAR(lookedUp(texture, 0.25, 0), 0.1, kClose);
  EXPECT_NEAR(lookedUp(texture, 0.75, 0), 0.1, kClose) << "half way from 0.2 to 0 of the next tile";
  EXPECT_NEAR(lookedUp(texture, 0.25, 0.25), (0 + 0.2 + 0.4 + 1) / 4, kClose);
}

TEST(ImageTexture, RangeIsHighThenLow) {
  const TextureFile file("gray", "1 1\n\x33\x33\x33");
  const TextureHit hit = applied<ImageTexture>(file.path() + " component diffuse range 2 1", hitAtUv(0, 0));
  EXPECT_NEAR(hit.surface.diffuse.r, 1 + (2 - 1) * 0.2, kClose);
  EXPECT_EQ(hit.surface.ambient, kWhite);
}

TEST(ImageTexture, TilesLimitWhereItIs) {
  ImageTexture texture = textureOf(1, 1, 1, {0});
  auto there = [&texture](double tilesU, double tilesV, double u, double v) {
    texture.tilesU = tilesU;
    texture.tilesV = tilesV;
    return lookedUp(texture, u, v) == 0;
  };
  EXPECT_TRUE(there(0, 0, -7, 9));
  EXPECT_TRUE(there(2, 0, 1.5, 9));
  EXPECT_FALSE(there(2, 0, 2.5, 9));
  EXPECT_FALSE(there(2, 0, -0.5, 9));
  EXPECT_TRUE(there(0.0009, 0, -7, 9));
  EXPECT_FALSE(there(-2, 0, 1.5, 9));
  EXPECT_TRUE(there(-2, 0, 2.5, 9));
  EXPECT_FALSE(there(-2, 1, 2.5, 9));
  EXPECT_TRUE(there(-2, 1, 2.5, 0.5));
  EXPECT_FALSE(there(-2, -1, 1.5, 0.5));
  EXPECT_TRUE(there(-2, -1, 1.5, 1.5));
}

TEST(ImageTexture, AlphaMixesWithWhatWasThere) {
  EXPECT_EQ(lookedUp(textureOf(1, 1, 2, {0, 0}), 0, 0), 1);
  EXPECT_EQ(lookedUp(textureOf(1, 1, 2, {0, 255}), 0, 0), 0);
  EXPECT_NEAR(lookedUp(textureOf(1, 1, 4, {0, 0, 0, 51}), 0, 0), 0.8, kClose);
}

TEST(ImageTexture, BumpTakesTheStepToTheNextPixel) {
  ImageTexture texture = grayTexture();
  texture.component = ImageTexture::Component::bump;
  TextureHit hit = hitAtUv(0.1, 0.1);
  texture.apply(hit);
  expectNear(hit.normal, normalize({-0.2, -0.4, 1}));
  EXPECT_EQ(hit.surface.diffuse, kWhite);
}

TEST(ImageTexture, ScalarComponentsNeedAGrayPicture) {
  const TextureFile file("rgb", "1 1\nabc");
  for (const char* component : {"reflect", "transp", "specpow", "bump", "index"})
    EXPECT_THROW(parsed<ImageTexture>(file.path() + " component " + component), std::runtime_error)
        << component;
  EXPECT_NO_THROW(parsed<ImageTexture>(file.path() + " component body"));
  EXPECT_THROW(parsed<ImageTexture>(file.path() + " component nothing"), std::runtime_error);
}

TEST(ImageTexture, OfAMissingFileNamesIt) {
  TextArguments in("/nowhere/picture.png");
  try {
    ImageTexture::parse(in);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/picture.png"), std::string::npos);
  }
}

}  // namespace
}  // namespace rayshade
