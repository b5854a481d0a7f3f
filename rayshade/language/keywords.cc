// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/keywords.h"

#include <array>

#include "rayshade/atmosphere/all.h"
#include "rayshade/lights/all.h"
#include "rayshade/shapes/all.h"
#include "rayshade/textures/all.h"

namespace rayshade {
namespace {

struct Entry {
  std::string_view text;
  Keyword keyword;
};

constexpr std::pair<std::string_view, Word> kWords[] = {
    {"ambient", Word::ambient},
    {"aperture", Word::aperture},
    {"applysurf", Word::applysurf},
    {"atmosphere", Word::atmosphere},
    {"background", Word::background},
    {"body", Word::body},
    {"contrast", Word::contrast},
    {"crop", Word::crop},
    {"cursurf", Word::cursurf},
    {"cutoff", Word::cutoff},
    {"define", Word::define},
    {"difference", Word::difference},
    {"diffuse", Word::diffuse},
    {"end", Word::end},
    {"extinct", Word::extinct},
    {"eyep", Word::eyep},
    {"eyesep", Word::eyesep},
    {"filter", Word::filter},
    {"focaldist", Word::focaldist},
    {"fov", Word::fov},
    {"framelength", Word::framelength},
    {"frames", Word::frames},
    {"grid", Word::grid},
    {"index", Word::index},
    {"intersect", Word::intersect},
    {"light", Word::lightSource},
    {"list", Word::list},
    {"lookp", Word::lookp},
    {"maxdepth", Word::maxdepth},
    {"name", Word::name},
    {"noshadow", Word::noshadow},
    {"object", Word::object},
    {"outfile", Word::outfile},
    {"print", Word::print},
    {"reflect", Word::reflect},
    {"reflective", Word::reflect},
    {"report", Word::report},
    {"resolution", Word::screen},
    {"rotate", Word::rotate},
    {"sample", Word::sample},
    {"scale", Word::scale},
    {"screen", Word::screen},
    {"shadowtransp", Word::shadowtransp},
    {"shutter", Word::shutter},
    {"specpow", Word::specpow},
    {"specular", Word::specular},
    {"starttime", Word::starttime},
    {"surface", Word::surface},
    {"texture", Word::placedTexture},
    {"transform", Word::transform},
    {"translate", Word::translate},
    {"translu", Word::translucency},
    {"translucency", Word::translucency},
    {"transp", Word::transparent},
    {"transparent", Word::transparent},
    {"union", Word::unite},
    {"up", Word::up},
    {"window", Word::window},
    // Arguments of textures, lights and options.
    {"component", Word::reserved},
    {"cylindrical", Word::reserved},
    {"gauss", Word::reserved},
    {"jitter", Word::reserved},
    {"map", Word::reserved},
    {"nojitter", Word::reserved},
    {"planar", Word::reserved},
    {"quiet", Word::reserved},
    {"range", Word::reserved},
    {"smooth", Word::reserved},
    {"spherical", Word::reserved},
    {"textsurf", Word::reserved},
    {"tile", Word::reserved},
    {"uv", Word::reserved},
    {"verbose", Word::reserved},
};

template <class List>
struct KeywordsOf;
template <class... T>
struct KeywordsOf<TypeList<T...>> {
  static constexpr std::array<std::string_view, sizeof...(T)> texts{T::keyword...};
};

constexpr std::size_t kSlots = 512;  // a power of two, sparsely filled
constexpr std::size_t kLongestWord = 16;

constexpr std::size_t slotOf(std::string_view text) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return (hash ^ hash >> 15) % kSlots;
}

// A hash table with linear probing, filled by the compiler.
struct Table {
  std::array<Entry, kSlots> slots{};

  constexpr const Entry& find(std::string_view text) const {
    std::size_t at = slotOf(text);
    while (!slots[at].text.empty() && slots[at].text != text) at = (at + 1) % kSlots;
    return slots[at];
  }
  constexpr void add(std::string_view text, Keyword keyword) {  // the first entry of a word stays
    std::size_t at = slotOf(text);
    while (!slots[at].text.empty() && slots[at].text != text) at = (at + 1) % kSlots;
    if (slots[at].text.empty()) slots[at] = {text, keyword};
  }
  template <class List>
  constexpr void addList(Word word) {
    for (std::size_t i = 0; i < List::size; ++i)
      add(KeywordsOf<List>::texts[i], {word, static_cast<std::uint8_t>(i)});
  }
};

constexpr Table makeTable() {
  Table table;
  for (const auto& [text, word] : kWords) table.add(text, {word, 0});
  table.addList<AllShapes>(Word::shape);
  table.addList<AllTextures>(Word::texture);
  table.addList<AllLights>(Word::light);
  table.addList<AllEffects>(Word::effect);
  const Entry polygon = table.find("polygon");
  if (!polygon.text.empty()) table.add("poly", polygon.keyword);
  return table;
}

constexpr Table kTable = makeTable();

}  // namespace

Keyword findKeyword(std::string_view text) {
  if (text.size() > kLongestWord) return {};
  return kTable.find(text).keyword;
}

}  // namespace rayshade
