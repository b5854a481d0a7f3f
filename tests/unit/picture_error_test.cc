// Errors of pictures, against values that were computed by hand or, for FLIP, by a direct sum over the paper's
// two-dimensional filters.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/image/picture_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "rayshade/image/flip.h"
#include "tests/support/program.h"

namespace rayshade {
namespace {

Picture uniform(int width, int height, std::array<float, 3> color) {
  Picture picture{width, height, {}};
  for (int i = 0; i < width * height; ++i)
    picture.pixels.insert(picture.pixels.end(), color.begin(), color.end());
  return picture;
}

void set(Picture& picture, int x, int y, std::array<float, 3> color) {
  for (std::size_t c = 0; c < 3; ++c)
    picture.pixels[static_cast<std::size_t>(3 * (y * picture.width + x)) + c] = color[c];
}

TEST(PictureError, OfAPictureAndItselfIsNothing) {
  Picture picture = uniform(9, 7, {.25f, .5f, 2});
  set(picture, 3, 4, {-1, 0, 7});
  const PictureError error = pictureError(picture, picture);
  EXPECT_EQ(error.mrse, 0);
  EXPECT_EQ(error.rmse, 0);
  EXPECT_EQ(error.flip, 0);
  EXPECT_EQ(error.worst.mrse, 0);
}

TEST(PictureError, IsRelativeInMrseAndAbsoluteInRmse) {
  Picture reference = uniform(2, 1, {.5f, 0, 0}), picture = reference;
  set(reference, 1, 0, {.25f, .25f, 0});
  set(picture, 1, 0, {.5f, .25f, .125f});
  const PictureError error = pictureError(reference, picture);
  const double red = .25 / .26, blue = .125 / .01;
  EXPECT_DOUBLE_EQ(error.mrse, (red * red + blue * blue) / 6);
  EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((.0625 + .015625) / 6));
  EXPECT_EQ(error.worst.x, 1);
  EXPECT_EQ(error.worst.y, 0);
  EXPECT_DOUBLE_EQ(error.worst.mrse, (red * red + blue * blue) / 3);
  EXPECT_EQ(error.worst.reference, (std::array<float, 3>{.25f, .25f, 0}));
  EXPECT_EQ(error.worst.picture, (std::array<float, 3>{.5f, .25f, .125f}));
}

TEST(PictureError, NegativeLightIsAsLargeAsItsAmount) {
  EXPECT_DOUBLE_EQ(pictureError(uniform(1, 1, {-.5f, -.5f, -.5f}), uniform(1, 1, {0, 0, 0})).mrse,
                   .25 / (.51 * .51));
}

TEST(PictureError, TheFirstOfTheWorstPixelsIsNamed) {
  const Picture reference = uniform(4, 3, {1, 1, 1});
  Picture picture = reference;
  set(picture, 2, 1, {0, 1, 1});
  set(picture, 1, 2, {1, 0, 1});
  const PictureError error = pictureError(reference, picture);
  EXPECT_EQ(error.worst.x, 2);
  EXPECT_EQ(error.worst.y, 1);
}

TEST(PictureError, DemandsEqualSizesAndFinitePixels) {
  const Picture good = uniform(4, 3, {1, 1, 1});
  EXPECT_EQ(whyNotComparable(good, good), "");
  EXPECT_EQ(whyNotComparable(good, uniform(3, 4, {1, 1, 1})),
            "the reference has 4 by 3 pixels, the picture 3 by 4");
  EXPECT_NE(whyNotComparable({}, {}), "");
  Picture bad = good;
  set(bad, 1, 2, {1, std::numeric_limits<float>::quiet_NaN(), 1});
  EXPECT_EQ(whyNotComparable(good, bad), "picture: pixel 1 2 is not a finite number");
  set(bad, 1, 2, {1, std::numeric_limits<float>::infinity(), 1});
  EXPECT_EQ(whyNotComparable(bad, good), "reference: pixel 1 2 is not a finite number");
}

double flipOf(std::array<float, 3> a, std::array<float, 3> b) {
  return pictureError(uniform(3, 2, a), uniform(3, 2, b)).flip;
}

TEST(Flip, OfUniformPicturesIsTheErrorOfTheirColours) {
  EXPECT_NEAR(flipOf({0, 1, 0}, {0, 0, 1}), 1, 1e-6) << "the largest difference that there is";
  EXPECT_NEAR(flipOf({0, 0, 0}, {1, 1, 1}), .96737976, 1e-6);
  EXPECT_NEAR(flipOf({.5f, .5f, .5f}, {.4f, .4f, .4f}), .21559233, 1e-6);
}

TEST(Flip, LightThatNoScreenShowsIsCutOff) {
  EXPECT_EQ(flipOf({1, 1, 1}, {5, 1, 900}), 0);
  EXPECT_EQ(flipOf({0, 0, 0}, {-1, 0, -7}), 0);
}

TEST(Flip, OfOnePixelSpreadsToItsNeighbours) {
  const Picture reference = uniform(5, 3, {.2f, .2f, .2f});
  Picture picture = reference;
  set(picture, 2, 1, {.9f, .1f, .3f});
  const std::vector<double> errors = flipErrors(reference, picture);
  const double expected[] = {.0639021,   .150675485, .199401257, .150675485, .0639021,
                             .085400196, .199401257, .262496611, .199401257, .085400196,
                             .0639021,   .150675485, .199401257, .150675485, .0639021};
  ASSERT_EQ(errors.size(), std::size(expected));
  for (std::size_t i = 0; i < errors.size(); ++i) EXPECT_NEAR(errors[i], expected[i], 1e-6) << i;
}

TEST(Flip, FromFartherAwaySmallThingsMatterLess) {
  const Picture reference = uniform(64, 64, {.5f, .5f, .5f});
  Picture picture = reference;
  for (int y = 0; y < 64; ++y)  // fine red and blue that are grey on the average
    for (int x = 0; x < 64; ++x)
      set(picture, x, y, (x + y) % 2 == 0 ? std::array{.6f, .5f, .4f} : std::array{.4f, .5f, .6f});
  const std::vector<double> near = flipErrors(reference, picture, 20),
                            far = flipErrors(reference, picture, 200);
  EXPECT_LT(far[64 * 32 + 32], .7 * near[64 * 32 + 32]);
}

class ErrorProgram : public testing::Test {
 protected:
  std::string put(const std::string& name, const Picture& picture) {
    PictureWriter writer(scratch_ / name, picture.width, picture.height);
    for (std::size_t i = 0; i < picture.pixels.size();) {
      std::vector<Color> row;
      for (int x = 0; x < picture.width; ++x, i += 3)
        row.push_back({picture.pixels[i], picture.pixels[i + 1], picture.pixels[i + 2]});
      writer.row(row);
    }
    writer.finish();
    return scratch_ / name;
  }
  Finished run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), programDirectory() + "/rayshade-error");
    return Program(arguments, scratch_ / "run").wait(20);
  }

  ScratchDirectory scratch_{"picture-error"};
};

TEST_F(ErrorProgram, SaysTheErrorsOfAllFormats) {
  const Picture reference = uniform(4, 3, {.2f, .4f, .6f}), picture = uniform(4, 3, {.2f, .4f, .8f});
  for (const char* end : {".pfm", ".ppm", ".png", ".out"}) {
    SCOPED_TRACE(end);
    const std::string a = put(std::string("a") + end, reference), b = put(std::string("b") + end, picture);
    const Finished text = run({a, b}), json = run({a, b, "--json"});
    EXPECT_EQ(text.status, 0) << text.errors;
    EXPECT_EQ(text.output.find("mrse   "), 0u);
    EXPECT_NE(text.output.find("worst  pixel 0 0: "), std::string::npos) << text.output;
    EXPECT_EQ(json.status, 0) << json.errors;
    double mrse = 0, rmse = 0, flip = 0;
    ASSERT_EQ(std::sscanf(json.output.c_str(), "{\"mrse\": %lf, \"rmse\": %lf, \"flip\": %lf,", &mrse, &rmse,
                          &flip),
              3)
        << json.output;
    EXPECT_NEAR(rmse, .2 / std::sqrt(3), .005);
    EXPECT_NEAR(mrse, .04 / (.61 * .61) / 3, .002);
    EXPECT_GT(flip, 0);
  }
}

TEST_F(ErrorProgram, WritesThePictureOfTheDifference) {
  const std::string a = put("a.pfm", uniform(4, 3, {0, 1, 0})), b = put("b.pfm", uniform(4, 3, {0, 0, 1}));
  EXPECT_EQ(run({a, b, "--difference", scratch_ / "d.pfm"}).status, 0);
  const Picture difference = readPicture(scratch_ / "d.pfm");
  ASSERT_EQ(difference.width, 4);
  ASSERT_EQ(difference.height, 3);
  for (float value : difference.pixels) EXPECT_NEAR(value, 1, 1e-6);
}

TEST_F(ErrorProgram, RefusesWhatCannotBeCompared) {
  const std::string good = put("a.pfm", uniform(4, 3, {1, 1, 1})),
                    other = put("b.pfm", uniform(3, 3, {1, 1, 1}));
  Picture bad = uniform(4, 3, {1, 1, 1});
  bad.pixels[7] = std::numeric_limits<float>::quiet_NaN();
  std::ofstream(scratch_ / "text.png") << "no picture";
  for (const std::string& file :
       {other, put("nan.pfm", bad), scratch_ / "missing.pfm", scratch_ / "text.png", scratch_.path()}) {
    SCOPED_TRACE(file);
    const Finished finished = run({good, file});
    EXPECT_EQ(finished.status, 1);
    EXPECT_EQ(finished.output, "");
    EXPECT_NE(finished.errors.find(file), std::string::npos) << finished.errors;
    EXPECT_EQ(countLines(finished.errors), 1u);
  }
  EXPECT_EQ(run({good}).status, 2);
  EXPECT_EQ(run({good, good, "--unknown"}).status, 2);
}

}  // namespace
}  // namespace rayshade
