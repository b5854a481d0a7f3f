// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/keywords.h"

#include <array>

#include "rayshade/atmosphere/all.h"
#include "rayshade/lights/all.h"
#include "rayshade/shapes/all.h"
#include "rayshade/textures/all.h"

namespace rayshade {
namespace {

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

constexpr std::size_t kSlots = 512;       // a power of two, sparsely filled
constexpr std::size_t kLongestWord = 16;  // letters: longer ones are not looked for

constexpr std::size_t slotOf(std::string_view text) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return (hash ^ hash >> 15) % kSlots;
}

// Calls use(word) for each word that the language knows a member of a list by.
template <class T, class Use>
constexpr void forEachWord(Use use) {
  if constexpr (!requires { typename T::SharesKeywordOf; }) use(std::string_view(T::keyword));
  if constexpr (requires { T::aliases; })
    for (const std::string_view alias : T::aliases) use(alias);
}

// Calls use(word, keyword) for each word of all members of a list.
template <class List, class Use>
constexpr void forEachWordOf(Word kind, Use use) {
  static_assert(List::size <= 256, "Keyword::index is a byte");
  std::size_t position = 0;
  List::forEach([&]<class T>() {
    forEachWord<T>([&](std::string_view word) {
      use(word, Keyword{kind, static_cast<std::uint8_t>(position)});
    });
    ++position;
  });
}

template <class Use>
constexpr void forEachWordOfTheLanguage(Use use) {
  for (const auto& [text, word] : kWords) use(text, Keyword{word, 0});
  forEachWordOf<AllShapes>(Word::shape, use);
  forEachWordOf<AllTextures>(Word::texture, use);
  forEachWordOf<AllLights>(Word::light, use);
  forEachWordOf<AllEffects>(Word::effect, use);
}

// ---- what a word must be

constexpr bool isReadAsOneWord(std::string_view text) {
  for (const char c : text)
    if (!(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9')) return false;
  return !text.empty() && text[0] >= 'a';
}
constexpr bool isTaken(std::string_view text) {  // by more than the one who asks
  int times = 0;
  forEachWordOfTheLanguage([&](std::string_view other, Keyword) { times += other == text ? 1 : 0; });
  return times > 1;
}
constexpr bool isShort(std::string_view text) { return text.size() <= kLongestWord; }

template <class T>
constexpr bool allWords(bool (*holds)(std::string_view)) {
  bool all = true;
  forEachWord<T>([&](std::string_view word) { all = all && holds(word); });
  return all;
}

// The compiler says in which type the word stands: "In instantiation of ... CheckedWords<Sphere>".
template <class T>
struct CheckedWords {
  static_assert(
      allWords<T>(isShort),
      "a keyword or alias of this type has more than kLongestWord letters and would never be found: "
      "choose a shorter one in the file of the type, or raise kLongestWord in "
      "rayshade/language/keywords.cc");
  static_assert(allWords<T>(isReadAsOneWord),
                "a keyword or alias of this type is no word of small letters and digits and would never be "
                "found: change it in the file of the type");
  static_assert(
      allWords<T>([](std::string_view word) { return !isTaken(word); }),
      "a keyword or alias of this type is taken by another shape, texture, light or effect, or by the "
      "language (kWords in rayshade/language/keywords.cc): choose another in the file of the type");
};
template <class... T>
constexpr bool checkWordsOf(TypeList<T...>) {
  return ((sizeof(CheckedWords<T>) > 0) && ...);
}
static_assert(checkWordsOf(AllShapes{}) && checkWordsOf(AllTextures{}) && checkWordsOf(AllLights{}) &&
              checkWordsOf(AllEffects{}));
static_assert(
    [] {
      for (const auto& [text, word] : kWords)
        if (!isShort(text) || isTaken(text)) return false;
      return true;
    }(),
    "a word of kWords is taken, or has more than kLongestWord letters");

// ---- the table

// A hash table with linear probing, filled by the compiler.
struct Table {
  std::array<WordOfTheLanguage, kSlots> slots{};
  std::size_t used = 0;

  constexpr std::size_t find(std::string_view text) const {  // its slot, or the free one where it would stand
    std::size_t at = slotOf(text);
    while (!slots[at].text.empty() && slots[at].text != text) at = (at + 1) % kSlots;
    return at;
  }
  constexpr Table() {
    forEachWordOfTheLanguage([this](std::string_view text, Keyword keyword) {
      slots[find(text)] = {text, keyword};
      ++used;
    });
  }
};

constexpr Table kTable;
static_assert(kTable.used <= kSlots / 2, "raise kSlots: looking for names takes long in a full table");

}  // namespace

Keyword findKeyword(std::string_view text) {
  if (text.size() > kLongestWord) return {};
  return kTable.slots[kTable.find(text)].keyword;
}

std::vector<WordOfTheLanguage> wordsOfTheLanguage() {
  std::vector<WordOfTheLanguage> words;
  forEachWordOfTheLanguage([&words](std::string_view text, Keyword keyword) {
    words.push_back({text, keyword});
  });
  return words;
}

}  // namespace rayshade
