// The examples of docs/language.md and docs/compatibility.md: each is read and rendered, without warnings, and shows something.
// The manual has an example of every word of the language.
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "rayshade/language/parser.h"
#include "rayshade/language/viewing.h"
#include "rayshade/trace/render.h"

namespace rayshade {
namespace {

std::string textOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The blocks between ```rayshade and ```.
std::vector<std::string> examplesOf(const std::string& document) {
  const std::string text = textOf(document), open = "\n```rayshade\n", close = "\n```\n";
  std::vector<std::string> examples;
  for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at)) {
    at += open.size();
    const std::size_t end = text.find(close, at);
    examples.push_back(text.substr(at, end == std::string::npos ? end : end - at) + "\n");
  }
  return examples;
}

// A file of its own, because the preprocessor reads files.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) {
    std::string name = (std::filesystem::temp_directory_path() / "language-XXXXXX").string();
    close(mkstemp(name.data()));
    name_ = name;
    std::ofstream(name_, std::ios::binary) << text;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(name_); }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

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
  head.picture.samplesPerSide = head.settings.samplesPerSide = std::min(head.picture.samplesPerSide, 2);
  scene.settings = head.settings;
  scene.prepare(exposureOf(head.picture, 0));
  std::vector<Color> pixels;
  renderFrame(scene, *viewOf(head.camera, head.picture), head.picture, 0, 0,
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

template <class List>
void addKeywords(std::set<std::string>& words) {
  List::forEach([&]<class T>() { words.emplace(T::keyword); });
}

TEST(Language, TheManualHasAnExampleOfEveryWord) {
  std::set<std::string> wanted;
  const std::string source = textOf("rayshade/language/keywords.cc");
  const std::regex entry("\\{\"([a-z]+)\", Word::");
  for (std::sregex_iterator at(source.begin(), source.end(), entry), end; at != end; ++at)
    wanted.insert((*at)[1]);
  EXPECT_GT(wanted.size(), 60u);
  addKeywords<AllShapes>(wanted);
  addKeywords<AllTextures>(wanted);
  addKeywords<AllLights>(wanted);
  addKeywords<AllEffects>(wanted);
  wanted.insert("poly");

  std::set<std::string> shown;
  const std::regex comment("/\\*[^*]*\\*/"), word("[a-z]+");
  for (const std::string& example : examplesOf("docs/language.md")) {
    const std::string text = std::regex_replace(example, comment, " ");
    for (std::sregex_iterator at(text.begin(), text.end(), word), end; at != end; ++at)
      shown.insert(at->str());
  }
  for (const std::string& keyword : wanted)
    EXPECT_TRUE(shown.contains(keyword)) << keyword << " has no example";
}

}  // namespace
}  // namespace rayshade
