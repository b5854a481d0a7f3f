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
      : tokens_(tokens),
        print_(options.print),
        log_(tokens, options.warn),
        objects_(tokens, log_, sink, *options.images, options.flipTriangleNormals),
        in_(objects_.arguments()) {}

  // Reads all there is; the messages of what is wrong are in errors() then.
  SceneHead parse();
  const std::string& errors() const { return log_.errors(); }
  // Lines, each with its newline; what is no error is said.
  std::string errorsOf(const SceneText::Verdict& verdict);
  void finish() { log_.finish(); }

 private:
  void statement();
  void define();

  Tokens& tokens_;
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
  const std::string keyword(tokens_.text());
  in_.advance();
  if (readViewing(word, in_, head_)) return head_.places.set(keyword, tokens_.describe(in_.subject));
  if (word == Word::define) return define();
  const double value = in_.number();  // of `print`, the only one left
  if (print_) print_(std::to_string(value));
}

std::string Parser::errorsOf(const SceneText::Verdict& verdict) {
  std::string errors;
  int count = 0;
  for (const PreprocessorMessage& message : verdict.messages) {
    if (!verdict.failed || message.isWarning) {
      log_.warn(message.text, message.complete);
    } else if (++count <= kMostErrors) {
      errors += message.complete + "\n";
    }
  }
  return errors;
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
    errors = parser.errorsOf(verdict) + errors;
    if (errors.ends_with('\n')) errors.pop_back();
  }
  parser.finish();
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
  parser.finish();
  if (!parser.errors().empty()) throw SceneError(parser.errors());
  return head;
}

}  // namespace rayshade
