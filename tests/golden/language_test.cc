// The examples of docs/language.md and docs/compatibility.md: each is read and rendered, without warnings, and shows something.
// The manual has an example of every word of the language.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "rayshade/language/parser.h"
#include "rayshade/language/viewing.h"
#include "rayshade/trace/render.h"
#include "tests/support/manual.h"

namespace rayshade {
namespace {

std::vector<Color> renderTiny(const std::string& example) {
  const TemporaryFile file(example);
  ParseOptions options;
  options.fileName = file.name();
  options.warn = [](const std::string& message) { ADD_FAILURE() << message; };
  Scene scene;
  SceneHead head = parseScene(options, scene.model.store());
  checkHead(head, "example");
  head.picture.width = 16;
  head.picture.height = 12;
  head.picture.window.reset();
  head.picture.samplesPerSide = std::min(head.picture.samplesPerSide, 2);
  agreeOnSamples(head);
  scene.settings = head.settings;
  scene.prepare(exposureOf(head.picture, 0));
  std::vector<Color> pixels;
  renderFrame(scene, {*viewOf(head.camera, head.picture), head.picture}, 0, 1,
              [&](const std::vector<Color>& row) { pixels.insert(pixels.end(), row.begin(), row.end()); });
  return pixels;
}

void renderExamples(const std::string& document, std::size_t least) {
  const std::vector<std::string> examples = examplesOf(document);
  ASSERT_GE(examples.size(), least) << document << ": run the tests from the top of the repository";
  for (const std::string& example : examples) {
    SCOPED_TRACE(document + ":\n" + example);
    try {
      const std::vector<Color> pixels = renderTiny(example);
      EXPECT_TRUE(std::any_of(pixels.begin(), pixels.end(), [&](Color c) { return c != pixels[0]; }))
          << "nothing is to be seen";
      EXPECT_TRUE(
          std::all_of(pixels.begin(), pixels.end(), [](Color c) { return std::isfinite(c.r + c.g + c.b); }));
    } catch (const SceneError& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

TEST(Language, EveryExampleOfTheManualIsRenderedWithoutAWarning) { renderExamples("docs/language.md", 30); }

TEST(Language, EverySceneOfADifferenceIsRenderedWithoutAWarning) {
  renderExamples("docs/compatibility.md", 10);
}

// All words of the language, and what each is.
using Words = std::map<std::string, std::string>;

template <class List>
void addKeywords(Words& words, const std::string& kind) {
  List::forEach([&]<class T>() {
    words.emplace(T::keyword, kind);
    if constexpr (requires { T::aliases; })
      for (const std::string_view alias : T::aliases) words.emplace(alias, kind);
  });
}

Words wordsOfTheLanguage() {
  Words words;
  addKeywords<AllShapes>(words, "the primitive of rayshade/shapes");
  addKeywords<AllTextures>(words, "the texture of rayshade/textures");
  addKeywords<AllLights>(words, "the light of rayshade/lights");
  addKeywords<AllEffects>(words, "the effect of rayshade/atmosphere");
  const std::string source = textOf("rayshade/language/keywords.cc");
  const std::regex entry("\\{\"([a-z]+)\", Word::");
  for (std::sregex_iterator at(source.begin(), source.end(), entry), end; at != end; ++at)
    words.emplace((*at)[1], "the word of rayshade/language/keywords.cc");
  return words;
}

TEST(Language, TheManualHasAnExampleOfEveryWord) {
  const Words words = wordsOfTheLanguage();
  EXPECT_GT(words.size(), 100u);
  std::set<std::string> shown;
  const std::regex comment("/\\*[^*]*\\*/"), word("[a-z][a-z0-9]*");
  for (const std::string& example : examplesOf("docs/language.md")) {
    const std::string text = std::regex_replace(example, comment, " ");
    for (std::sregex_iterator at(text.begin(), text.end(), word), end; at != end; ++at)
      shown.insert(at->str());
  }
  for (const auto& [keyword, kind] : words)
    EXPECT_TRUE(shown.contains(keyword)) << "docs/language.md has no example of `" << keyword << "`, " << kind
                                         << ": add a scene that shows it, in a block ```rayshade";
}

}  // namespace
}  // namespace rayshade
