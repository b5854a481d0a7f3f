// The words of the language.
//
// Every word here is reserved: nothing in a scene can be named so.  The words that make a shape, a texture, a
// light or an atmospheric effect come from their closed lists, so that a new type needs no edit here; Keyword
// then says the position in the list.  Words that only the types themselves ask for (through
// Arguments::accept) are `reserved`.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace rayshade {

enum class Word : std::uint8_t {
  none,  // a name
  reserved,
  // Members of the closed lists.
  shape,
  texture,
  light,
  effect,
  // Surfaces.
  ambient,
  body,
  diffuse,
  extinct,
  index,
  noshadow,
  reflect,
  specpow,
  specular,
  translucency,
  transparent,
  cursurf,
  // Inside of an instance.
  end,
  placedTexture,  // the word `texture`
  rotate,
  scale,
  transform,
  translate,
  // What a statement may begin with, besides a shape.
  aperture,
  applysurf,
  atmosphere,
  background,
  contrast,
  crop,
  cutoff,
  define,
  difference,
  eyep,
  eyesep,
  filter,
  focaldist,
  fov,
  framelength,
  frames,
  grid,
  intersect,
  lightSource,  // the word `light`
  list,
  lookp,
  maxdepth,
  name,
  object,
  outfile,
  print,
  report,
  sample,
  screen,
  shadowtransp,
  shutter,
  starttime,
  surface,
  unite,  // the word `union`
  up,
  window,
};

struct Keyword {
  Word word = Word::none;
  std::uint8_t index = 0;  // of a shape, texture, light or effect: its position in the closed list
};

Keyword findKeyword(std::string_view text);

struct WordOfTheLanguage {
  std::string_view text;
  Keyword keyword;
};
std::vector<WordOfTheLanguage> wordsOfTheLanguage();  // all of them

constexpr bool isComponent(Word word) { return word >= Word::ambient && word <= Word::transparent; }
constexpr bool isTransform(Word word) { return word >= Word::rotate && word <= Word::translate; }
constexpr bool beginsStatement(Word word) { return word >= Word::aperture || word == Word::shape; }
constexpr bool isCsg(Word word) {
  return word == Word::unite || word == Word::intersect || word == Word::difference;
}
constexpr bool isAggregate(Word word) { return word == Word::list || word == Word::grid || isCsg(word); }

}  // namespace rayshade
