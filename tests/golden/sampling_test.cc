// How far pictures of random samples are from what they are of, with nets and with the strata of the original; and how much of the
// light of small things is left.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/render_text.h"

namespace rayshade {
namespace {

constexpr int kSeeds = 8;

// The red channel of the pixels of a scene.
std::vector<double> rendered(const std::string& scene, Sampling sampling, int side, int seed) {
  Job job = jobOfText("contrast 0 0 0 " + scene);
  job.options.samples = side;
  job.options.sampling = sampling == Sampling::strata ? "strata" : "nets";
  job.options.seed = static_cast<std::uint64_t>(seed);
  const Rendered picture = renderSequentially(job);
  std::vector<double> red;
  for (std::size_t i = 0; i < picture.frames[0].pixels.size(); i += 3)
    red.push_back(picture.frames[0].pixels[i]);
  return red;
}

// The mean of the squares of errors; of a picture that is not known, from the mean over the seeds.
double squaredError(const std::string& scene, Sampling sampling, int side, std::vector<double> exact = {}) {
  std::vector<std::vector<double>> pictures;
  for (int seed = 1; seed <= kSeeds; ++seed) pictures.push_back(rendered(scene, sampling, side, seed));
  const bool known = !exact.empty();
  if (!known) {
    exact.resize(pictures[0].size());
    for (const auto& picture : pictures)
      for (std::size_t i = 0; i < exact.size(); ++i) exact[i] += picture[i] / kSeeds;
  }
  double sum = 0;
  for (const auto& picture : pictures)
    for (std::size_t i = 0; i < exact.size(); ++i) sum += (picture[i] - exact[i]) * (picture[i] - exact[i]);
  return sum / (known ? kSeeds : kSeeds - 1) / static_cast<double>(exact.size());
}

double gain(const std::string& scene, int side, const std::vector<double>& exact = {}) {
  return squaredError(scene, Sampling::strata, side, exact) /
         squaredError(scene, Sampling::nets, side, exact);
}

// The scene of tests/bench/area_light: a floor under a rectangular light that a screen half covers.
std::string halfShadow(int points) {
  const std::string n = std::to_string(points);
  return "screen 32 24 eyep 0 -7 3 lookp 0 0 0 up 0 0 1 fov 40 30.5 light 1 area -2 -1.5 8 2 -1.5 8 " + n +
         " -2 1.5 8 " + n +
         " surface floor ambient 0 0 0 diffuse .8 .8 .8 surface black ambient 0 0 0 diffuse 0 0 0 "
         "plane floor 0 0 0 0 0 1 polygon black -90 -90 4 0 -90 4 0 90 4 -90 90 4";
}

TEST(Sampling, NetsGiveHalfShadowsFarLessVarianceThanStrata) {
  EXPECT_GT(gain(halfShadow(2), 3), 3);
  EXPECT_GT(gain(halfShadow(2), 4), 5);
  EXPECT_GT(gain(halfShadow(1), 8), 10);
}

// Of the points of the unit cube those with w x < limit: a sum over the corners, for cubes of any dimension.
double shareBelow(const std::vector<double>& weights, double limit) {
  double sum = 0, scale = 1;
  for (std::size_t corner = 0; corner < std::size_t{1} << weights.size(); ++corner) {
    double rest = limit, sign = 1;
    for (std::size_t d = 0; d < weights.size(); ++d)
      if ((corner >> d & 1) != 0) {
        rest -= weights[d];
        sign = -sign;
      }
    if (rest > 0) sum += sign * std::pow(rest, weights.size());
  }
  for (std::size_t d = 0; d < weights.size(); ++d) scale *= weights[d] * static_cast<double>(d + 1);
  return sum / scale;
}

// White where x + y / 2 < 0 on a plane at distance 14, focus at 10, half side of the lens 0.25.
TEST(Sampling, NetsGiveBlurredEdgesLessErrorThanStrata) {
  constexpr int kWidth = 32, kHeight = 24;
  const double step = 2 * 14 * std::tan(std::numbers::pi / 9) / kWidth;  // of a pixel, on that plane
  std::vector<double> exact;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double u = (x - 0.5 - kWidth / 2) * step, v = (y - 0.5 - kHeight / 2) * step;
      // x + y / 2 = u + a step - (v + b step) / 2 - 0.1 (2 c - 1) - 0.05 (2 d - 1); a coordinate turned round has the other sign.
      exact.push_back(shareBelow({step, step / 2, 0.2, 0.1}, -u + v / 2 + step / 2 + 0.15));
    }
  const std::string scene =
      "screen 32 24 eyep 0 0 10 lookp 0 0 0 up 0 1 0 fov 40 30.5369432627651 aperture .25 focaldist 10 light "
      "1 ambient "
      "surface white "
      "ambient 1 1 1 diffuse 0 0 0 polygon white -100 200 -4 100 -200 -4 -500 -200 -4 -500 200 -4";
  EXPECT_GT(gain(scene, 4, exact), 1.3);
  EXPECT_GT(gain(scene, 8, exact), 1.3);
  EXPECT_LT(squaredError(scene, Sampling::nets, 16, exact), 1e-4);  // else the answer is not the right one
}

}  // namespace
}  // namespace rayshade
