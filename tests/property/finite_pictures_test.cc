// Whatever number stands where the language takes one, there is an error with its place, or a picture of finite values.
//
// The words come from the language's own tables: a new one must say here how it is written, or that it takes no numbers.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "rayshade/language/keywords.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

// A scene in which the numbers of `phrase` are tried.
struct Trial {
  std::string before, phrase, behind;
};

// What stands in front: light from two sides, and a surface that does everything with it.
const std::string kView = "screen 4 3 sample 1 nojitter eyep 0.3 -4 1.2 fov 40 maxdepth 4 ";
const std::string kSurface =
    "surface s ambient .1 .1 .1 diffuse .5 .5 .5 specular .5 .5 .5 specpow 9 reflect .4 transp .4 body .9 .9 "
    ".9 "
    "index 1.3 extinct .9 translu .3 .4 .4 .4 3 ";
const std::string kLights = "light 1 point 3 -4 5 light .5 directional -1 1 1 ";
const std::string kObjects = " list sphere s 1 0 0 0 box s 1 0 0 2 1 1 disc s 9 0 0 -1 0 0 1 end ";

// Each word that is no shape, texture, light or effect, in a place where it may stand.  Empty: takes no number.
std::map<std::string_view, Trial> trialsOfWords() {
  const std::string scene = kSurface + kLights + kObjects;
  const std::string head = kView + kLights;
  auto viewing = [&](const std::string& phrase) { return Trial{kView, phrase, scene}; };
  auto surface = [&](const std::string& phrase) {
    return Trial{head + kSurface, " surface s s " + phrase, kObjects};
  };
  auto objects = [&](const std::string& phrase) { return Trial{head + kSurface + kObjects, phrase, ""}; };
  auto mapping = [&](const std::string& phrase) {
    return objects("texture image docs/examples/letter.png " + phrase);
  };
  const Trial none{};
  return {
      {"ambient", surface("ambient 1 1 1")},
      {"aperture", viewing("aperture .1")},
      {"applysurf", none},
      {"atmosphere", viewing("atmosphere 1.1")},
      {"background", viewing("background .1 .2 .3")},
      {"body", surface("body 1 1 1")},
      {"component", none},
      {"contrast", {kView, "sample 2 contrast .1 .1 .1", scene}},
      {"crop", viewing("crop 0 1 0 1")},
      {"cursurf", none},
      {"cutoff", viewing("cutoff .1 .1 .1")},
      {"cylindrical", mapping("map cylindrical 0 0 0 0 0 1 1 0 0")},
      {"define", viewing("define x 1")},
      {"difference", none},
      {"diffuse", surface("diffuse 1 1 1")},
      {"end", none},
      {"extinct", surface("extinct .5")},
      {"eyep", viewing("eyep 0 -4 1")},
      {"eyesep", viewing("eyesep .1")},
      {"filter", viewing("filter gauss 1.8")},
      {"focaldist", viewing("aperture .1 focaldist 3")},
      {"fov", viewing("fov 40 30")},
      {"framelength", viewing("framelength 1")},
      {"frames", viewing("frames 1")},
      {"gauss", none},
      {"grid", {head + kSurface, "grid 2 2 2", "sphere s 1 0 0 0 end"}},
      {"index", surface("index 1.5")},
      {"intersect", none},
      {"jitter", none},
      {"light", viewing("light 1 1 1 ambient light 1 point 3 -4 5 light .5 .5 .5 point 2 -4 5")},
      {"list", none},
      {"lookp", viewing("lookp 0 0 0")},
      {"map", none},
      {"maxdepth", viewing("maxdepth 3")},
      {"name", none},
      {"nojitter", none},
      {"noshadow", none},
      {"object", none},
      {"outfile", none},
      {"planar", mapping("map planar 0 0 0 0 0 1 1 0 0")},
      {"print", viewing("print 1")},
      {"quiet", none},
      {"range", mapping("component diffuse range 1 0")},
      {"reflect", surface("reflect .5")},
      {"reflective", surface("reflective .5")},
      {"report", viewing("report 10")},
      {"resolution", viewing("resolution 4 3")},
      {"rotate", objects("rotate 0 0 1 30")},
      {"sample", viewing("sample 1")},
      {"scale", objects("scale 1 1 1")},
      {"screen", viewing("screen 4 3")},
      {"shadowtransp", none},
      {"shutter", {kView, "shutter 1", scene + " translate (time) 0 0"}},
      {"smooth", none},
      {"specpow", surface("specpow 9")},
      {"specular", surface("specular 1 1 1")},
      {"spherical", mapping("map spherical 0 0 0 0 0 1 1 0 0")},
      {"starttime", {kView, "starttime 1", scene + " translate (time) 0 0"}},
      {"surface", none},
      {"texture", none},
      {"textsurf", mapping("textsurf diffuse 1 1 1")},
      {"tile", mapping("tile 1 1")},
      {"transform", objects("transform 1 0 0 0 1 0 0 0 1 0 0 0")},
      {"translate", objects("translate 0 0 0")},
      {"translu", surface("translu .5 1 1 1 9")},
      {"translucency", surface("translucency .5 1 1 1 9")},
      {"transp", surface("transp .5")},
      {"transparent", surface("transparent .5")},
      {"union", none},
      {"up", viewing("up 0 0 1")},
      {"uv", none},
      {"verbose", none},
      {"window", viewing("window 0 3 0 2")},
  };
}

// Shapes, textures, lights and effects, as their own examples have them.
std::vector<Trial> trialsOfMembers() {
  const std::string head = kView + kSurface;
  std::vector<Trial> trials;
  auto phrase = [](auto keyword, std::string_view example) {
    return std::string(keyword) + " " + std::string(example);
  };
  AllShapes::forEach([&]<class T>() {
    for (std::string_view example : T::examples)
      trials.push_back(
          {head + kLights, std::string(T::keyword) + " s " + std::string(example), " plane s 0 0 -1 0 0 1"});
  });
  AllTextures::forEach([&]<class T>() {
    for (std::string_view example : T::examples)
      trials.push_back({head + kLights + kObjects, "texture " + phrase(T::keyword, example), ""});
  });
  AllLights::forEach([&]<class T>() {
    for (std::string_view example : T::examples)
      trials.push_back({head, "light 1 " + phrase(T::keyword, example), kObjects});
  });
  AllEffects::forEach([&]<class T>() {
    for (std::string_view example : T::examples)
      trials.push_back({head + kLights, "atmosphere 1 " + phrase(T::keyword, example), kObjects});
  });
  return trials;
}

bool isNumber(const std::string& word) {
  double value = 0;
  const char* const end = word.data() + word.size();
  return std::from_chars(word.data(), end, value).ptr == end;
}

// The scene of a trial, with other words in place of its phrase.
std::string sceneWith(const Trial& trial, const std::vector<std::string>& words) {
  std::string text = trial.before;
  for (const std::string& word : words) text += " " + word;
  return text + " " + trial.behind;
}

std::vector<std::string> wordsOf(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

// Empty: an error that names the place, or a picture of finite values.
std::string whatIsWrongWith(const std::string& text, std::string& error) {
  const Job job = jobOfText(text);
  try {
    struct Nowhere final : SceneSink {
      void surface(SurfaceId, const Surface&) override {}
      void node(NodeId, SceneNode) override {}
      void object(SceneObject) override {}
      void endOfStatement() override {}
    } nowhere;
    const SceneHead head = job.read(nowhere);
    const PictureSpec& picture = head.picture;
    if (picture.frames > 2 || picture.width > 100 || picture.height > 100) return "";  // takes too long
  } catch (const SceneError& problem) {
    error = problem.what();
    return error.find(": error: ") != error.npos ? "" : error;
  }
  const Rendered rendered = renderSequentially(job);
  for (const Picture& picture : rendered.frames)
    for (float light : picture.pixels)
      if (!std::isfinite(light)) return "a pixel is " + std::to_string(light);
  return rendered.notFinite == 0 ? "" : "samples that are not finite";
}

void expectFinite(const Trial& trial) {
  const std::vector<std::string> words = wordsOf(trial.phrase);
  std::string good;
  EXPECT_EQ(whatIsWrongWith(sceneWith(trial, words), good), "");
  EXPECT_EQ(good, "") << "the phrase itself must be right";
  for (const char* all : {"1e300", "-1e300", "1e30", "1e6", "-1e6", "1e-300"}) {  // everywhere at once
    std::vector<std::string> tried = words;
    std::replace_if(tried.begin(), tried.end(), isNumber, all);
    const std::string text = sceneWith(trial, tried);
    std::string error;
    EXPECT_EQ(whatIsWrongWith(text, error), "") << text;
  }
  for (std::size_t at = 0; at < words.size(); ++at) {
    if (!isNumber(words[at])) continue;
    std::vector<std::string> values = {"0",      "-1",   "1",     "1e-300", "-1e-300",      "1e300",
                                       "-1e300", "1e30", "-1e30", "1e-30",  "(1e308 * 10)", "(0 / 0)"};
    std::set<std::string> known(values.begin(), values.end());
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::vector<std::string> tried = words;
      tried[at] = values[i];
      const std::string text = sceneWith(trial, tried);
      std::string error;
      EXPECT_EQ(whatIsWrongWith(text, error), "") << text;
      // The ends of a range that an error names are tried, too.
      static const std::regex end("-?[0-9][0-9.]*(e[-+]?[0-9]+)?");
      const std::size_t range = error.find("number ");
      if (range == error.npos) continue;
      const std::string said = error.substr(range, error.find(" is expected") - range);
      for (std::sregex_iterator found(said.begin(), said.end(), end), none; found != none; ++found)
        if (known.insert(found->str()).second) values.push_back(found->str());
    }
  }
}

TEST(FinitePictures, ForAnyNumberBehindAWord) {
  const auto trials = trialsOfWords();
  std::size_t taken = 0;
  for (const WordOfTheLanguage& word : wordsOfTheLanguage()) {
    if (word.keyword.word >= Word::shape && word.keyword.word <= Word::effect) continue;
    const auto trial = trials.find(word.text);
    ASSERT_NE(trial, trials.end()) << word.text << ": say in this file which numbers it takes";
    ++taken;
    expectFinite(trial->second);
  }
  EXPECT_EQ(taken, trials.size()) << "words that the language does not have";
}

TEST(FinitePictures, ForAnyNumberOfAShapeTextureLightOrEffect) {
  for (Trial trial : trialsOfMembers()) {
    for (const auto& [name, file] :
         {std::pair{"picture.png", "docs/examples/letter.png"}, {"colors.map", "docs/examples/warm.map"}})
      if (const std::size_t at = trial.phrase.find(name); at != std::string::npos)
        trial.phrase.replace(at, std::string(name).size(), file);
    expectFinite(trial);
  }
}

TEST(FinitePictures, WhereEveryStepGivesMoreThanItGot) {
  std::string between =
      kView + "maxdepth 300 sample 1 " + kLights +
      "surface s ambient 1 1 1 diffuse 1 0 1 specular 1e30 0 1e30 reflect 1e30 transp 1e30 body 1e30 0 1 "
      "translu 1e30 1 1 0 1e9 plane s 0 2 0 0 1 0 plane s 0 -5 0 0 1 0 ";
  std::string textured = kView + kLights + kSurface + "sphere s 1 0 0 0 ";
  std::string windows = kView + kLights + "plane diffuse 1 0 1 0 0 -1 0 0 1 ";
  for (int i = 0; i < 70; ++i) {
    between += "light 1e30 0 1 point 0 9 0 ";
    textured +=
        "texture fbm 1e30 1e30 .5 2 5 0 texture fbmbump 1e30 1e30 .5 2 5 "
        "texture image docs/examples/letter.png component body range 1e30 1e30 ";
    windows += "disc transp 1e30 body 1 0 1 9 0 0 " + std::to_string(i) + " 0 0 1 ";
  }
  for (const std::string& text : {between, textured, windows}) {
    std::string error;
    EXPECT_EQ(whatIsWrongWith(text, error), "");
    EXPECT_EQ(error, "");
  }
}

}  // namespace
}  // namespace rayshade
