// One small picture per feature, equal to the one that is kept: what changes a pixel must be seen and be wanted.
//
//   RAYSHADE_GOLDEN_WRITE=1 bin/rayshade-tests --gtest_filter='Golden*'      writes them anew: look at them, then commit
//
// Levels are compared, not files: how zlib packs them is not ours.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>

#include "tests/support/compare_pictures.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

struct Feature {
  const char *name, *scene;
  const char* sampling = "nets";
};

// In front of every scene; later statements override.
constexpr const char* kStage = R"(
screen 48 36 sample 1 nojitter eyep 0 -6 2 lookp 0 0 .2 fov 40 background .1 .2 .4
light .8 point -3 -4 5
surface red ambient .1 .02 .02 diffuse .8 .2 .1 specular .4 .4 .4 specpow 20
surface blue ambient .02 .02 .1 diffuse .1 .2 .8
surface white ambient .1 .1 .1 diffuse .8 .8 .8
surface glass diffuse .1 .1 .1 specular .8 .8 .8 specpow 30 reflect .2 transp .8 body .9 1 .9 index 1.5
surface mirror diffuse .1 .1 .1 specular .9 .9 .9 specpow 30 reflect .8
plane white 0 0 -1 0 0 1 texture checker blue
)";

constexpr Feature kFeatures[] = {
    {"sphere", "sphere red 1 0 0 0"},
    {"box", "box red -1 -1 -1 .8 1 .4 rotate 0 0 1 30"},
    {"disc", "disc red 1.2 0 0 0 .2 -1 1"},
    {"cylinder", "cylinder red .6 -.5 0 -1 .5 0 1"},
    {"cone", "cone red .9 0 0 -1 .3 .2 0 .8"},
    {"torus", "torus red .9 .3 0 0 0 .3 -.4 1"},
    {"triangle", "triangle red -1 0 -1 1 0 -1 0 .5 1"},
    {"phong-triangle", "triangle red -1 0 -1 -.5 -1 -.3 1 0 -1 .5 -1 -.3 0 .5 1 0 -.5 .7"},
    {"triangleuv",
     "triangleuv red -1 0 -1 0 -1 0 0 0 1 0 -1 0 -1 0 1 0 0 .5 1 0 -1 0 0 1 texture stripe blue .2 .1"},
    {"polygon", "polygon red -1 0 -1 1 0 -1 1 0 1 0 0 0 -1 0 1"},
    {"blob", "blob red .3 1 1 -.4 0 0 1 1 .5 0 .2"},
    {"heightfield", "heightfield red tests/support/hills.hf scale 3 3 1 translate -1.5 -1 -.8"},
    {"union", "union sphere red .8 -.4 0 0 box blue 0 -.5 -.5 1 .5 .5 end"},
    {"intersection", "intersect sphere red 1 0 0 0 box blue -.7 -.7 -.7 .7 .7 .7 end"},
    {"difference", "difference box red -.8 -.8 -.8 .8 .8 .8 sphere blue 1 0 -.4 .3 end rotate 0 0 1 20"},
    {"instance",
     "name pair list sphere red .4 -.4 0 0 box blue 0 -.3 -.3 .6 .3 .3 end object pair translate -.8 0 0 "
     "object pair rotate 0 0 1 90 translate .8 0 .3"},
    {"grid", "grid 3 3 3 sphere red .4 -.8 0 0 sphere blue .4 0 0 .3 sphere white .4 .8 0 0 end"},
    {"transform", "box red -1 -1 -1 1 1 1 transform .5 .2 0 0 .6 .1 .2 0 .7 .1 0 0"},
    {"glass", "sphere glass 1 0 0 0 sphere red .5 .5 2 0"},
    {"mirror", "sphere mirror 1 0 0 0 sphere red .4 -1 -1 0"},
    {"extinct", "sphere glass extinct .4 1 0 0 0"},
    {"translucency",
     "disc ambient .1 .1 .1 diffuse .5 .5 .5 translu .7 .8 .3 .1 10 1.5 0 1 0 0 -1 .1 light .6 point 1 5 3"},
    {"opaque-shadows", "shadowtransp sphere glass 1 0 0 0"},
    {"directional", "light .5 directional 1 -1 1 sphere red 1 0 0 0"},
    {"spot", "light .9 spot 3 -3 4 0 0 0 3 10 25 sphere red .7 0 0 0"},
    {"extended", "sample 2 nojitter contrast 0 0 0 light .7 extended .6 3 -3 4 sphere red .7 0 0 0"},
    {"area", "sample 2 nojitter light .7 area 2 -3 4 4 -3 4 2 2 -1 4 2 sphere red .7 0 0 0"},
    {"ambient", "light .2 .6 .2 ambient sphere red 1 0 0 0"},
    {"fog", "atmosphere fog .7 .7 .8 6 6 6 sphere red 1 0 0 0"},
    {"mist", "atmosphere mist .7 .7 .8 4 4 4 0 1 sphere red 1 0 0 0"},
    {"fogdeck", "atmosphere fogdeck .5 .3 1 1 1 1 4 .8 .8 .8 2 2 2 sphere red 1 0 0 0"},
    {"marble", "sphere red 1 0 0 0 texture marble scale .3 .3 .3"},
    {"wood", "box red -1 -1 -1 1 1 .7 texture wood scale .4 .4 .4"},
    {"bump", "sphere red 1 0 0 0 texture bump .6 scale .2 .2 .2"},
    {"blotch", "sphere red 1 0 0 0 texture blotch .1 blue scale .3 .3 .3"},
    {"fbm", "sphere red 1 0 0 0 texture fbm .4 .8 .6 2 5 0 scale .4 .4 .4"},
    {"fbmbump", "sphere red 1 0 0 0 texture fbmbump 0 .8 .6 2 5 scale .3 .3 .3"},
    {"gloss", "sample 2 nojitter sphere mirror 1 0 0 0 texture gloss .8"},
    {"cloud", "sphere white 1 0 0 0 texture cloud 1 .8 2 4 .2 .6 .3"},
    {"sky", "sphere white 1 0 0 0 texture sky 1 .8 2 4 .6 .3"},
    {"stripe", "cylinder red .8 0 0 -1 0 0 1 texture stripe blue .2 .2 scale .25 .25 1"},
    {"windy", "sphere red 1 0 0 0 texture windy .5 1 1 .3 3 2 .5 .1 scale .3 .3 .3"},
    {"mount",
     "heightfield white tests/support/hills.hf scale 3 3 1 translate -1.5 -1 -.8 "
     "texture mount tests/data/suite/snow.map .1 .3"},
    {"image", "sphere white 1 0 0 0 texture image tests/data/suite/letter.mtv map spherical"},
    {"image-body",
     "sphere glass 1 0 0 0 texture image tests/data/suite/letter.mtv component body smooth map cylindrical"},
    {"lens", "sample 2 nojitter aperture .2 focaldist 4 sphere red 1 0 0 0"},
    {"motion", "sample 2 nojitter contrast 0 0 0 shutter 1 sphere red .6 -.5 0 0 translate (time) 0 0"},
    {"gauss", "sample 3 nojitter filter gauss 2 contrast 0 0 0 sphere red 1 0 0 0"},
    {"jitter", "sample 3 jitter contrast .1 .1 .1 sphere red 1 0 0 0"},
    {"window", "window 10 30 5 30 crop .1 .9 0 1 sphere red 1 0 0 0"},
    // The bits of the original's strata.
    {"extended-strata", "sample 2 nojitter contrast 0 0 0 light .7 extended .6 3 -3 4 sphere red .7 0 0 0",
     "strata"},
    {"area-strata", "sample 2 nojitter light .7 area 2 -3 4 4 -3 4 2 2 -1 4 2 sphere red .7 0 0 0", "strata"},
    {"gloss-strata", "sample 2 nojitter sphere mirror 1 0 0 0 texture gloss .8", "strata"},
    {"lens-strata", "sample 2 nojitter aperture .2 focaldist 4 sphere red 1 0 0 0", "strata"},
    {"jitter-strata", "sample 3 jitter contrast .1 .1 .1 sphere red 1 0 0 0", "strata"},
};

class Golden : public testing::TestWithParam<Feature> {};

TEST_P(Golden, ThePictureIsTheOneThatIsKept) {
  const Feature& feature = GetParam();
  const std::string file = std::string("tests/golden/") + feature.name + ".png";
  Rendered rendered;
  try {
    Job job = jobOfText(std::string(kStage) + feature.scene);
    job.options.sampling = feature.sampling;
    rendered = renderSequentially(job);
  } catch (const std::exception& error) {
    FAIL() << error.what();
  }
  const Picture& got = rendered.frames.at(0);
  const auto asFile = [&](const std::string& name) {
    PictureWriter writer(name, got.width, got.height);
    std::vector<Color> row(static_cast<std::size_t>(got.width));
    for (std::size_t y = 0; y < static_cast<std::size_t>(got.height); ++y) {
      for (std::size_t x = 0; x < row.size(); ++x) {
        const float* pixel = &got.pixels[3 * (y * row.size() + x)];
        row[x] = {pixel[0], pixel[1], pixel[2]};
      }
      writer.row(row);
    }
    writer.finish();
  };
  if (numberFromEnvironment("RAYSHADE_GOLDEN_WRITE", 0) != 0) asFile(file);
  ASSERT_TRUE(std::filesystem::exists(file)) << "see the head of golden_test.cc";
  const std::string fresh =
      std::filesystem::temp_directory_path() / ("rayshade-golden-" + std::to_string(getpid()) + ".png");
  asFile(fresh);
  EXPECT_EQ(difference(readPicture(fresh), readPicture(file)), "") << feature.scene;
  std::filesystem::remove(fresh);
}

INSTANTIATE_TEST_SUITE_P(Feature, Golden, testing::ValuesIn(kFeatures), [](const auto& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

}  // namespace
}  // namespace rayshade
