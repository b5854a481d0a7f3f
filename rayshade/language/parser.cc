// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/parser.h"

#include <utility>

#include "rayshade/language/object_parser.h"
#include "rayshade/language/preprocessor.h"
#include "rayshade/language/viewing.h"

namespace rayshade {
namespace {

class Parser {
 public:
  Parser(Tokens& tokens, const ParseOptions& options, SceneSink& sink)
      : print_(options.print),
        log_(tokens, options.warn),
        objects_(tokens, log_, sink, options.flipTriangleNormals),
        in_(objects_.arguments()) {}

  // Reads all there is; the messages of what is wrong are in errors() then.
  SceneHead parse();
  const std::string& errors() const { return log_.errors(); }

 private:
  void statement();
  void define();

  const std::function<void(const std::string&)>& print_;
  FaultLog log_;
  ObjectParser objects_;
  ArgumentReader& in_;
  Scope world_;
  SceneHead head_;
};

SceneHead Parser::parse() {
  try {
    objects_.recovering(world_, [this] { in_.advance(); });
    while (in_.token().kind != Token::Kind::end) {
      objects_.recovering(world_, [this] {
        statement();
        objects_.sink().endOfStatement();
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
  if (objects_.statement(word, world_)) return;
  in_.advance();
  if (readViewing(word, in_, head_)) return;
  if (word == Word::define) return define();
  const double value = in_.number();  // of `print`, the only one left
  if (print_) print_(std::to_string(value));
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
