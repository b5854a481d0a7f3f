// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/object_parser.h"

#include <algorithm>
#include <array>
#include <utility>

#include "rayshade/language/parse_member.h"
#include "rayshade/language/parser.h"

namespace rayshade {
namespace {

bool beginsInstance(Word word) { return word == Word::shape || word == Word::object || isAggregate(word); }
bool mayBeMember(Word word) {
  return beginsInstance(word) || word == Word::surface || word == Word::name || word == Word::applysurf;
}

// One keyword makes two shapes: a triangle has three points, or three points and three normals.
std::optional<AnyShape> parseShape(std::size_t position, Arguments& in) {
  if (position != PositionIn<Triangle, AllShapes>::value) return parseMember<AllShapes>(position, in);
  const auto triangle = parseTriangle(in);
  if (!triangle) return std::nullopt;
  return std::visit([](const auto& kind) -> AnyShape { return kind; }, *triangle);
}

AnyShape flippedWhereWanted(AnyShape shape, bool flip) {
  if (!flip) return shape;
  return std::visit(
      [](auto& member) -> AnyShape {
        if constexpr (requires { member.flipped(); }) {
          return member.flipped();
        } else {
          return std::move(member);
        }
      },
      shape);
}

// By position in AllShapes.
constexpr auto kBeginsWithFile = []<class... S>(TypeList<S...>) {
  return std::array{BeginsWithFile<S>...};
}(AllShapes{});

// `heightfield [surface] FILE`: a name is a surface only if something follows that can be the file.
// A shape of a file never takes what `applysurf` has set.
SurfaceId surfaceBeforeFile(ArgumentReader& in, SceneSink& sink) {
  if (in.word() == Word::cursurf || isComponent(in.word())) return in.boundSurface(sink).id;
  const TokenPlace place = in.token().place;
  const std::string first = in.fileName();
  if (isComponent(in.word()) || in.fileNameFollows()) return in.boundSurface(first, place, sink).id;
  in.unread(first);
  return kNoSurface;
}

Modifiers readModifiers(ArgumentReader& in, FaultLog& log) {
  Modifiers modifiers;
  modifiers.transforms = in.transforms();
  while (in.word() == Word::placedTexture) {
    in.advance();
    const Token type = in.token();
    if (in.word() != Word::texture) in.unexpected("a texture");
    in.subject = type.place;
    in.advance();
    auto texture = parseMember<AllTextures>(type.keyword.index, in);
    TransformChain transforms = in.transforms();
    if (!texture) {
      log.warn(type.place, "this texture changes nothing: it is left out");
      continue;
    }
    modifiers.textures.push_back({std::move(*texture), std::move(transforms)});
  }
  return modifiers;
}

// Notes how high the tower below a scope is.
void nest(Scope& scope, int height, const TokenPlace& place) {
  if (scope.depth + height > kDeepestNesting)
    throw Fault{"objects are nested more than " + std::to_string(kDeepestNesting) + " levels deep", place,
                true};
  scope.height = std::max(scope.height, height);
}

}  // namespace

// After an error: goes on to what may be the next statement of this scope, or its `end`.
void ObjectParser::findStatement(const Scope& scope) {
  while (in_.token().kind != Token::Kind::end) {
    const Word word = in_.word();
    if (scope.depth > 0 && word == Word::end) break;
    // A word in the middle of a line that was no good there is no statement either.
    const bool wrong = log_.wasAt(in_.token().place) && !tokens_.firstInLine();
    if (!wrong && (scope.depth > 0 ? mayBeMember(word) : beginsStatement(word))) break;
    tokens_.advance();
  }
  in_.current = scope.current;
}

bool ObjectParser::statement(Word word, Scope& scope) {
  if (beginsInstance(word)) {
    instance(scope);
    return true;
  }
  if (word == Word::surface) {
    defineSurface();
  } else if (word == Word::name) {
    defineObject(scope);
  } else if (word == Word::applysurf) {
    tokens_.advance();
    in_.current = scope.current = in_.boundSurface(sink());
  } else {
    return false;
  }
  return true;
}

void ObjectParser::defineSurface() {
  tokens_.advance();
  const TokenPlace place = in_.token().place;
  const std::string name = in_.name("a surface");
  try {
    const Surface surface = in_.surfaceFollows() ? in_.surface() : Surface{};
    if (!surfaces_.define(name, surface)) log_.warn(place, "surface `" + name + "` is defined again");
  } catch (const Fault&) {
    surfaces_.define(name, Surface{});  // one message is enough: its uses are right
    throw;
  }
}

void ObjectParser::defineObject(const Scope& scope) {
  tokens_.advance();
  const std::string name = in_.name("an object");
  Scope inner;
  inner.container = items_.newDefinition();
  inner.current = scope.current;
  inner.depth = scope.depth + 1;
  try {
    if (!beginsInstance(in_.word())) in_.unexpected("an object");
    instance(inner);
  } catch (const Fault&) {
    objects_.insert_or_assign(name, NamedObject{.failed = true});
    throw;
  }
  objects_.insert_or_assign(name,
                            NamedObject{inner.container, inner.members == 0, inner.failed, inner.height});
}

void ObjectParser::instance(Scope& scope) {
  in_.subject = in_.token().place;
  const Word word = in_.word();
  if (word == Word::shape) return primitive(scope);
  if (word == Word::object) return namedInstance(scope);
  aggregate(scope);
}

void ObjectParser::primitive(Scope& scope) {
  const Token keyword = in_.token();
  const std::string word(tokens_.text());  // short: no memory is taken
  tokens_.advance();
  SurfaceId surface = scope.current.id;
  if (kBeginsWithFile[keyword.keyword.index]) {
    surface = surfaceBeforeFile(in_, sink());
  } else if (in_.surfaceFollows()) {
    surface = in_.boundSurface(sink()).id;
  }
  std::optional<AnyShape> shape = parseShape(keyword.keyword.index, in_);
  Modifiers modifiers = readModifiers(in_, log_);
  if (!shape) return log_.warn(keyword.place, "degenerate " + word + ": it is left out");
  items_.object(scope, flippedWhereWanted(std::move(*shape), flipNormals_), surface, std::move(modifiers));
}

// `object [surface] NAME`
void ObjectParser::namedInstance(Scope& scope) {
  const TokenPlace place = in_.token().place;
  tokens_.advance();
  SurfaceId surface = scope.current.id;
  if (in_.word() == Word::cursurf || isComponent(in_.word())) surface = in_.boundSurface(sink()).id;
  TokenPlace namePlace = in_.token().place;
  std::string name = in_.name("an object");
  if (in_.nameFollows() || isComponent(in_.word())) {
    surface = in_.boundSurface(name, namePlace, sink()).id;
    namePlace = in_.token().place;
    name = in_.name("an object");
  }
  const auto known = objects_.find(name);
  if (known == objects_.end()) throw Fault{"undefined object `" + name + "`", namePlace};
  const NamedObject definition = known->second;
  Modifiers modifiers = readModifiers(in_, log_);
  if (definition.failed) {
    scope.failed = true;
    return;
  }
  if (definition.empty) return log_.warn(place, "object `" + name + "` is empty: it is left out");
  nest(scope, definition.height + 1, place);
  items_.object(scope, Instance{definition.id}, surface, std::move(modifiers));
}

void ObjectParser::aggregate(Scope& scope) {
  const TokenPlace place = in_.token().place;
  const Word opening = in_.word();
  const std::string word(tokens_.text());
  tokens_.advance();

  const bool csg = isCsg(opening);
  const bool dissolved = !csg && !scope.operands;
  Scope inner;
  inner.container = dissolved ? scope.container : items_.newDefinition();
  inner.node = dissolved ? items_.newNode() : kRootNode;
  inner.operands = csg;
  inner.depth = scope.depth + 1;
  nest(scope, 1, place);
  if (opening == Word::grid) gridSize(inner);
  members(inner, opening, place);
  nest(scope, inner.height + 1, place);
  scope.failed = scope.failed || inner.failed;
  in_.current = scope.current;

  Modifiers modifiers = readModifiers(in_, log_);
  if (inner.failed) return;  // how many members there are is not known then
  if (csg) {
    if (inner.members < 2)
      throw Fault{
          "the CSG operation `" + word + "` needs two objects and has " + std::to_string(inner.members),
          place};
    // differs from rayshade4: which crashes.
    if (inner.members > 2)
      log_.warn(place, "the CSG operation `" + word + "` has " + std::to_string(inner.members) +
                           " objects, in Rayshade 4 it has two" +
                           (opening == Word::difference ? ": all others are taken from the first" : ""));
    const CsgOperation operation = opening == Word::unite       ? CsgOperation::unite
                                   : opening == Word::intersect ? CsgOperation::intersect
                                                                : CsgOperation::subtract;
    return items_.object(scope, Csg{operation, inner.container}, scope.current.id, std::move(modifiers));
  }
  if (inner.members == 0) return log_.warn(place, "empty " + word + ": it is left out");
  if (!dissolved)
    return items_.object(scope, Instance{inner.container}, scope.current.id, std::move(modifiers));
  sink().node(inner.node,
              {scope.node, std::move(modifiers.transforms), scope.current.id, std::move(modifiers.textures)});
  ++scope.members;
}

// The size is of no use to us: objects are sorted by another structure.
void ObjectParser::gridSize(Scope& scope) {
  recovering(scope, [this] {
    const int x = in_.integer(), y = in_.integer(), z = in_.integer();
    if (x < 1 || y < 1 || z < 1) in_.warn("a grid has at least one cell along each axis: taken as a list");
  });
}

void ObjectParser::members(Scope& scope, Word opening, const TokenPlace& place) {
  in_.current = {};
  bool strayed = false;  // to what stands only at the top level: a forgotten `end` is said once
  while (in_.word() != Word::end) {
    const bool ended = in_.token().kind == Token::Kind::end;
    if (ended && strayed) throw Enough{};
    if (ended) throw Fault{"this aggregate has no `end`", place, true};
    const bool strays = beginsStatement(in_.word()) && !mayBeMember(in_.word());
    if (strays && std::exchange(strayed, true)) {
      findStatement(scope);
      continue;
    }
    recovering(scope, [&] {
      if (!statement(in_.word(), scope))
        in_.unexpected(isCsg(opening) ? "an operand or `end`" : "an object or `end`");
    });
  }
  tokens_.advance();
}

}  // namespace rayshade
