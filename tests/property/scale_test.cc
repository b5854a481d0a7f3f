// Scenes as small, as large and as far away as you like.
//
// Scaled by a power of two a picture keeps its bits: nothing is compared with a length that is not in the scene.  Scaled by
// another factor, or moved, the numbers of the scene are rounded, so levels may differ where an edge of something falls
// exactly between two pixels.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/support/compare_pictures.h"
#include "tests/support/number_text.h"
#include "tests/support/random.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

// A text in which every length is multiplied by `scale` and every place moved by `far` along x, y and z before.
class ScaledScene {
 public:
  ScaledScene(std::uint64_t seed, double scale, double far) : random_(seed), scale_(scale), far_(far) {
    text_ = "screen 32 24 sample 1 nojitter maxdepth 3 fov 45 background .1 .2 .3";
    word("eyep").place(0.3, -7, 2).word("lookp").place(0, 0, 0.1);
    word("light .7 point").place(-3, -5, 6).word("light .4 directional -1 -1 2");
    text_ +=
        "\nsurface red ambient .1 .05 .05 diffuse .7 .3 .2 specular .5 .5 .5 specpow 12 reflect .3"
        "\nsurface blue ambient .05 .05 .1 diffuse .2 .3 .7"
        "\nsurface glass diffuse .1 .1 .1 specular .6 .6 .6 specpow 20 transp .7 index 1.4\n";
    word("plane blue").place(0, 0, -1.5).word("0.1 0 1");
    for (int i = 0; i < 12; ++i) shape();
  }
  const std::string& text() const { return text_; }

 private:
  ScaledScene& word(const char* w) {
    text_ += std::string("\n") + w;
    return *this;
  }
  ScaledScene& number(double x) {
    text_ += rayshade::text(x);
    return *this;
  }
  ScaledScene& length(double x) { return number(scale_ * x); }
  ScaledScene& place(double x, double y, double z) {
    return number(scale_ * (far_ + x)).number(scale_ * (far_ + y)).number(scale_ * (far_ + z));
  }
  void shape() {
    const char* surfaces[] = {"red", "blue", "glass"};
    const std::string surface = surfaces[random_.below(3)];
    const double x = random_.real(-2.5, 2.5), y = random_.real(-2, 2), z = random_.real(-1, 1.5),
                 r = random_.real(0.2, 0.7);
    const auto named = [&](const char* keyword) -> ScaledScene& {
      return word((std::string(keyword) + " " + surface).c_str());
    };
    switch (random_.below(9)) {
      case 0:
        named("sphere").length(r).place(x, y, z);
        break;
      case 1:
        named("box").place(x, y, z).place(x + r, y + 2 * r, z + r / 2);
        break;
      case 2:
        named("cylinder").length(r / 2).place(x, y, z).place(x + r, y - r, z + 1);
        break;
      case 3:
        named("cone").length(r).place(x, y, z).length(0).place(x, y + r / 3, z + 1);
        break;
      case 4:
        named("torus").length(r).length(r / 3).place(x, y, z);
        text_ += " .3 -.5 1";
        break;
      case 5:
        named("triangle").place(x, y, z).place(x + 1, y, z).place(x, y + r, z + 1);
        break;
      case 6:
        named("disc").length(r).place(x, y, z);
        text_ += " .2 -1 .3";
        break;
      case 7:
        named("blob").number(0.4).number(1).length(r).place(x, y, z).number(0.9).length(r).place(x + r, y, z);
        break;
      default:
        named("polygon").place(x, y, z).place(x + r, y, z).place(x + r, y, z + r).place(x, y, z + 2 * r);
    }
  }

  Random random_;
  double scale_, far_;
  std::string text_;
};

std::vector<Picture> rendered(std::uint64_t seed, double scale, double far = 0) {
  return renderSequentially(jobOfText(ScaledScene(seed, scale, far).text())).frames;
}

TEST(Scale, ByAPowerOfTwoKeepsEveryBitOfThePicture) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const std::vector<Picture> one = rendered(seed, 1);
    for (const double k : {0x1p20, 0x1p-20})
      EXPECT_EQ(difference(rendered(seed, k), one), "") << seed << ' ' << k;
  }
}

TEST(Scale, ByAMillionChangesNoMoreThanRounding) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const std::vector<Picture> one = rendered(seed, 1);
    for (const double k : {1e6, 1e-6}) {
      const Distance d = distance(rendered(seed, k)[0], one[0]);
      EXPECT_LE(d.over1, 2.0 / (32 * 24)) << seed << ' ' << k;  // two pixels on an edge
    }
  }
}

TEST(Scale, MovedByAMillionTheSceneLooksTheSame) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Distance d = distance(rendered(seed, 1, 1e6)[0], rendered(seed, 1)[0]);
    EXPECT_LE(d.over1, 2.0 / (32 * 24)) << seed;
  }
}

}  // namespace
}  // namespace rayshade
