// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/parser.h"

#include <algorithm>
#include <utility>

#include "rayshade/language/argument_reader.h"
#include "rayshade/language/parse_member.h"
#include "rayshade/language/preprocessor.h"
#include "rayshade/language/viewing.h"

namespace rayshade {
namespace {

constexpr int kMostErrors = 20;

// Thrown when there is no point in looking for more that is wrong.
struct Enough {};

// What is read after an error is only checked.
class SilentSink final : public SceneSink {
 public:
  void surface(SurfaceId, const Surface&) override {}
  void node(NodeId, SceneNode) override {}
  void object(SceneObject) override {}
  void endOfStatement() override {}
};

bool beginsInstance(Word word) { return word == Word::shape || word == Word::object || isAggregate(word); }
bool mayBeMember(Word word) {
  return beginsInstance(word) || word == Word::surface || word == Word::name || word == Word::applysurf;
}

// Where objects are being put: the world, a definition, an aggregate.
struct Scope {
  DefinitionId container = kWorld;
  NodeId node = kRootNode;
  BoundSurface current;   // what `applysurf` has set
  bool operands = false;  // of a CSG operation: each of them stays whole
  int depth = 0;          // scopes around this one
  int members = 0;
  bool failed = false;  // something in it was wrong
  int height = 0;       // levels of aggregates and instances inside
};

// What `name` has defined.
struct Definition {
  DefinitionId id = kWorld;
  bool empty = true;
  bool failed = false;  // said already: its uses are right
  int height = 0;
};

// What may stand behind an object.
struct Placement {
  TransformChain transforms;
  std::vector<PlacedTexture> textures;
};

class Parser {
 public:
  Parser(Tokens& tokens, const ParseOptions& options, SceneSink& sink)
      : tokens_(tokens),
        options_(options),
        sink_(&sink),
        in_(tokens, surfaces_,
            [this](const TokenPlace& place, const std::string& text) { warn(place, text); }) {}

  // Reads all there is; the messages of what is wrong are in errors() then.
  SceneHead parse();
  const std::string& errors() const { return errors_; }

 private:
  std::string message(const TokenPlace& place, std::string_view kind, const std::string& text);
  void warn(const TokenPlace& place, const std::string& text);
  void report(const Fault& fault);
  void findStatement(const Scope& scope);

  void statement();
  bool sceneStatement(Word word, Scope& scope);
  void define();
  void defineSurface();
  void defineObject(const Scope& scope);

  void instance(Scope& scope);
  void primitive(Scope& scope);
  SurfaceId surfaceOfHeightField();
  void namedInstance(Scope& scope);
  void aggregate(Scope& scope);
  void gridSize(Scope& scope);
  template <class Read>
  void recovering(Scope& scope, const Read& read);
  void members(Scope& scope, Word opening, const TokenPlace& place);
  Placement placement();
  void put(Scope& scope, ObjectBody body, SurfaceId surface, Placement placement);
  void nest(Scope& scope, int height, const TokenPlace& place);

  DefinitionId newDefinition() { return DefinitionId{++definitions_}; }
  NodeId newNode() { return NodeId{++nodes_}; }

  Tokens& tokens_;
  const ParseOptions& options_;
  SceneSink* sink_;
  SilentSink silent_;
  SceneHead head_;
  SurfaceTable surfaces_;
  NameMap<Definition> objects_;
  ArgumentReader in_;
  Scope world_;
  std::uint32_t objectCount_ = 0, nodes_ = 0, definitions_ = 0;
  std::string errors_;
  int errorCount_ = 0;
  std::uint64_t wrong_ = 0;  // offset of the last token that was no good
};

// ---- messages

std::string Parser::message(const TokenPlace& place, std::string_view kind, const std::string& text) {
  std::string lines = describe(tokens_.describe(place)) + ": ";
  lines += kind;
  lines += ": " + text + "\n" + tokens_.excerpt(place);
  lines.pop_back();
  return lines;
}

void Parser::warn(const TokenPlace& place, const std::string& text) {
  if (options_.warn) options_.warn(message(place, "warning", text));
}

void Parser::report(const Fault& fault) {
  sink_ = &silent_;
  wrong_ = fault.place.offset;
  if (!errors_.empty()) errors_ += "\n";
  errors_ += message(fault.place, "error", fault.message);
  if (++errorCount_ == kMostErrors || fault.hopeless) throw Enough{};
}

// ---- statements

// Reads on behind what is wrong, still in the same scope.
template <class Read>
void Parser::recovering(Scope& scope, const Read& read) {
  bool lost = false;
  do {
    try {
      if (lost) {
        findStatement(scope);
      } else {
        read();
      }
      lost = false;
    } catch (const Fault& fault) {
      scope.failed = lost = true;
      report(fault);
    }
  } while (lost);
}

// After an error: goes on to what may be the next statement of this scope, or its `end`.
void Parser::findStatement(const Scope& scope) {
  while (in_.token().kind != Token::Kind::end) {
    const Word word = in_.word();
    if (scope.depth > 0 && word == Word::end) break;
    // A word in the middle of a line that was no good there is no statement either.
    const bool wrong = in_.token().place.offset == wrong_ && !tokens_.firstInLine();
    if (!wrong && (scope.depth > 0 ? mayBeMember(word) : beginsStatement(word))) break;
    tokens_.advance();
  }
  in_.current = scope.current;
}

SceneHead Parser::parse() {
  try {
    recovering(world_, [this] { tokens_.advance(); });
    while (in_.token().kind != Token::Kind::end) {
      recovering(world_, [this] {
        statement();
        sink_->endOfStatement();
      });
    }
  } catch (const Enough&) {
  }
  if (head_.settings.lights.empty())
    head_.settings.lights.push_back({DirectionalLight{normalize({1, -1, 1})}, kWhite, true});
  return std::move(head_);
}

void Parser::statement() {
  const Word word = in_.word();
  if (!beginsStatement(word)) in_.unexpected("a statement");
  in_.subject = in_.token().place;
  if (sceneStatement(word, world_)) return;
  tokens_.advance();
  if (readViewing(word, in_, head_)) return;
  if (word == Word::define) return define();
  const double value = in_.number();  // of `print`, the only one left
  if (options_.print) options_.print(std::to_string(value));
}

// What may stand in an aggregate as well; takes its keyword only if it is such a statement.
bool Parser::sceneStatement(Word word, Scope& scope) {
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
    in_.current = scope.current = in_.boundSurface(*sink_);
  } else {
    return false;
  }
  return true;
}

void Parser::define() {
  const TokenPlace place = in_.token().place;
  const std::string name = in_.name("a variable");
  std::optional<Expression> value;
  try {
    value = in_.expression();
  } catch (const Fault&) {
    in_.variables.add(name, constantExpression(1));  // one message is enough: its uses are right
    throw;
  }
  if (!in_.variables.add(name, std::move(*value))) throw Fault{"`" + name + "` is defined already", place};
}

void Parser::defineSurface() {
  tokens_.advance();
  const TokenPlace place = in_.token().place;
  const std::string name = in_.name("a surface");
  try {
    const Surface surface = in_.surfaceFollows() ? in_.surface() : Surface{};
    if (!surfaces_.define(name, surface)) warn(place, "surface `" + name + "` is defined again");
  } catch (const Fault&) {
    surfaces_.define(name, Surface{});  // one message is enough: its uses are right
    throw;
  }
}

void Parser::defineObject(const Scope& scope) {
  tokens_.advance();
  const std::string name = in_.name("an object");
  Scope inner;
  inner.container = newDefinition();
  inner.current = scope.current;
  inner.depth = scope.depth + 1;
  try {
    if (!beginsInstance(in_.word())) in_.unexpected("an object");
    instance(inner);
  } catch (const Fault&) {
    objects_.insert_or_assign(name, Definition{.failed = true});
    throw;
  }
  objects_.insert_or_assign(name,
                            Definition{inner.container, inner.members == 0, inner.failed, inner.height});
}

// ---- objects

void Parser::instance(Scope& scope) {
  in_.subject = in_.token().place;
  const Word word = in_.word();
  if (word == Word::shape) return primitive(scope);
  if (word == Word::object) return namedInstance(scope);
  aggregate(scope);
}

// One keyword makes two shapes: a triangle has three points, or three points and three normals.
std::optional<AnyShape> parseShape(std::size_t position, Arguments& in) {
  if (position != PositionIn<Triangle, AllShapes>::value) return parseMember<AllShapes>(position, in);
  const auto triangle = parseTriangle(in);
  if (!triangle) return std::nullopt;
  return std::visit([](const auto& kind) -> AnyShape { return kind; }, *triangle);
}

// Option -f turns the normals of the shapes that can turn them.
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

void Parser::primitive(Scope& scope) {
  const Token keyword = in_.token();
  const std::string word(tokens_.text());  // short: no memory is taken
  const bool heightField = word == "heightfield";
  tokens_.advance();
  SurfaceId surface = scope.current.id;
  if (heightField) {
    surface = surfaceOfHeightField();
  } else if (in_.surfaceFollows()) {
    surface = in_.boundSurface(*sink_).id;
  }
  std::optional<AnyShape> shape = parseShape(keyword.keyword.index, in_);
  Placement where = placement();
  if (!shape) return warn(keyword.place, "degenerate " + word + ": it is left out");
  put(scope, flippedWhereWanted(std::move(*shape), options_.flipTriangleNormals), surface, std::move(where));
}

// `heightfield [surface] FILE`: a name is a surface only if something follows that can be the file.
// A height field never takes what `applysurf` has set.
SurfaceId Parser::surfaceOfHeightField() {
  if (in_.word() == Word::cursurf || isComponent(in_.word())) return in_.boundSurface(*sink_).id;
  const TokenPlace place = in_.token().place;
  const std::string first = in_.fileName();
  if (isComponent(in_.word()) || in_.fileNameFollows()) return in_.boundSurface(first, place, *sink_).id;
  in_.unread(first);
  return kNoSurface;
}

// `object [surface] NAME`
void Parser::namedInstance(Scope& scope) {
  const TokenPlace place = in_.token().place;
  tokens_.advance();
  SurfaceId surface = scope.current.id;
  if (in_.word() == Word::cursurf || isComponent(in_.word())) surface = in_.boundSurface(*sink_).id;
  TokenPlace namePlace = in_.token().place;
  std::string name = in_.name("an object");
  if (in_.nameFollows() || isComponent(in_.word())) {
    surface = in_.boundSurface(name, namePlace, *sink_).id;
    namePlace = in_.token().place;
    name = in_.name("an object");
  }
  const auto known = objects_.find(name);
  if (known == objects_.end()) throw Fault{"undefined object `" + name + "`", namePlace};
  const Definition definition = known->second;
  Placement where = placement();
  if (definition.failed) {
    scope.failed = true;
    return;
  }
  if (definition.empty) return warn(place, "object `" + name + "` is empty: it is left out");
  nest(scope, definition.height + 1, place);
  put(scope, Instance{definition.id}, surface, std::move(where));
}

void Parser::nest(Scope& scope, int height, const TokenPlace& place) {
  if (scope.depth + height > kDeepestNesting)
    throw Fault{"objects are nested more than " + std::to_string(kDeepestNesting) + " levels deep", place,
                true};
  scope.height = std::max(scope.height, height);
}

void Parser::aggregate(Scope& scope) {
  const TokenPlace place = in_.token().place;
  const Word opening = in_.word();
  const std::string word(tokens_.text());
  tokens_.advance();

  const bool csg = isCsg(opening);
  const bool dissolved = !csg && !scope.operands;
  Scope inner;
  inner.container = dissolved ? scope.container : newDefinition();
  inner.node = dissolved ? newNode() : kRootNode;
  inner.operands = csg;
  inner.depth = scope.depth + 1;
  nest(scope, 1, place);
  if (opening == Word::grid) gridSize(inner);
  members(inner, opening, place);
  nest(scope, inner.height + 1, place);
  scope.failed = scope.failed || inner.failed;
  in_.current = scope.current;

  Placement where = placement();
  if (inner.failed) return;  // how many members there are is not known then
  if (csg) {
    if (inner.members != 2)
      throw Fault{"the CSG operation `" + word + "` needs exactly two objects and has " +
                      std::to_string(inner.members),
                  place};
    const CsgOperation operation = opening == Word::unite       ? CsgOperation::unite
                                   : opening == Word::intersect ? CsgOperation::intersect
                                                                : CsgOperation::subtract;
    return put(scope, Csg{operation, inner.container}, scope.current.id, std::move(where));
  }
  if (inner.members == 0) return warn(place, "empty " + word + ": it is left out");
  if (!dissolved) return put(scope, Instance{inner.container}, scope.current.id, std::move(where));
  sink_->node(inner.node,
              {scope.node, std::move(where.transforms), scope.current.id, std::move(where.textures)});
  ++scope.members;
}

// The size is of no use to us: objects are sorted by another structure.
void Parser::gridSize(Scope& scope) {
  recovering(scope, [this] {
    const int x = in_.integer(), y = in_.integer(), z = in_.integer();
    if (x < 1 || y < 1 || z < 1) in_.warn("a grid has at least one cell along each axis: taken as a list");
  });
}

void Parser::members(Scope& scope, Word opening, const TokenPlace& place) {
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
      if (!sceneStatement(in_.word(), scope))
        in_.unexpected(isCsg(opening) ? "an operand or `end`" : "an object or `end`");
    });
  }
  tokens_.advance();
}

Placement Parser::placement() {
  Placement where;
  where.transforms = in_.transforms();
  while (in_.word() == Word::placedTexture) {
    tokens_.advance();
    const Token type = in_.token();
    if (in_.word() != Word::texture) in_.unexpected("a texture");
    in_.subject = type.place;
    tokens_.advance();
    auto texture = parseMember<AllTextures>(type.keyword.index, in_);
    TransformChain transforms = in_.transforms();
    if (!texture) {
      warn(type.place, "this texture changes nothing: it is left out");
      continue;
    }
    where.textures.push_back({std::move(*texture), std::move(transforms)});
  }
  return where;
}

void Parser::put(Scope& scope, ObjectBody body, SurfaceId surface, Placement where) {
  NodeId node = scope.node;
  if (!where.transforms.empty() || !where.textures.empty()) {
    node = newNode();
    sink_->node(node, {scope.node, std::move(where.transforms), kNoSurface, std::move(where.textures)});
  }
  sink_->object({ObjectId{objectCount_++}, scope.container, node, surface, std::move(body)});
  ++scope.members;
}

}  // namespace

SceneHead parseScene(const ParseOptions& options, SceneSink& sink) {
  SceneText text(options.fileName, options.preprocess, options.preprocessorArguments);
  Tokens tokens([&text](char* to, std::size_t most) { return text.read(to, most); }, text.name());
  Parser parser(tokens, options, sink);
  SceneHead head = parser.parse();
  std::string errors = parser.errors();
  // Asking before cpp has ended would wait for output that nobody reads: an error ends it instead.
  if (errors.empty() || tokens.current().kind == Token::Kind::end) {
    const SceneText::Verdict verdict = text.verdict();
    if (verdict.failed) errors = verdict.messages + (errors.empty() ? "" : "\n") + errors;
    if (!verdict.failed && !verdict.messages.empty() && options.warn) options.warn(verdict.messages);
  }
  if (!errors.empty()) throw SceneError(errors);
  return head;
}

SceneHead parseSceneText(std::string_view text, const std::string& name, const ParseOptions& options,
                         SceneSink& sink) {
  std::size_t at = 0;
  Tokens tokens(
      [&](char* to, std::size_t most) {
        const std::size_t count = text.substr(at).copy(to, most);
        at += count;
        return count;
      },
      name);
  Parser parser(tokens, options, sink);
  SceneHead head = parser.parse();
  if (!parser.errors().empty()) throw SceneError(parser.errors());
  return head;
}

}  // namespace rayshade
