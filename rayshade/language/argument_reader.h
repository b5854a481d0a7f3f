// What follows a keyword, read from tokens: numbers, names, surfaces, transforms.
//
// Shapes, textures, lights and effects see it as Arguments; the statements of the language use the rest, too.
// Everything that is wrong leaves as a Fault; a fault found by a type itself (a light without direction) is
// put at the keyword that began it: see `subject`.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "rayshade/base/transform.h"
#include "rayshade/image/image_library.h"
#include "rayshade/language/expression_reader.h"
#include "rayshade/language/surface_table.h"
#include "rayshade/language/tokens.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

class ArgumentReader final : public Arguments {
 public:
  using Warn = std::function<void(const TokenPlace&, const std::string&)>;
  // The name of a file that was taken for something else at first.
  struct UnreadName {
    std::string text;
    TokenPlace place;
  };

  ArgumentReader(Tokens& tokens, SurfaceTable& surfaces, ImageLibrary& images, Warn warn)
      : tokens_(tokens), surfaces_(surfaces), images_(images), warn_(std::move(warn)) {}

  // Arguments
  bool numberFollows() override;
  bool accept(std::string_view word) override;
  bool fileNameFollows() override { return unread_.has_value() || tokens_.fileNameFollows(); }
  std::string inputFile() override;
  std::shared_ptr<const Image> inputImage() override;
  Surface surface() override;
  void warn(const std::string& message) override { warn_(subject, message); }
  [[noreturn]] void fail(const std::string& message) override { throw Fault{message, subject}; }

  // More than shapes and textures may ask for.
  const Token& token() const { return tokens_.current(); }
  Word word() const { return token().kind == Token::Kind::word ? token().keyword.word : Word::reserved; }
  bool nameFollows() const { return word() == Word::none; }
  bool surfaceFollows() const;
  void advance() { tokens_.advance(); }
  std::string name(std::string_view ofWhat);
  Expression expression();                     // a number or parenthesised expression; may depend on time
  BoundSurface boundSurface(SceneSink& sink);  // a surface-spec, for an object
  // The same when the name at its beginning has been read already.
  BoundSurface boundSurface(std::string_view name, const TokenPlace& place, SceneSink& sink);
  std::string fileName() { return tokens_.fileName(); }
  void unread(UnreadName name) { unread_ = std::move(name); }   // the next inputFile() gives it back
  TransformChain transforms();                                  // any number of them
  [[noreturn]] void unexpected(std::string_view wanted) const;  // something else stands here

  TokenPlace subject;    // the keyword whose arguments are being read
  BoundSurface current;  // `cursurf`: what `applysurf` has set where we are
  Variables variables;

 private:
  double take(const Range& range, bool whole) override;
  double unchecked();  // a number
  bool symbolFollows(char symbol) const;
  double signedNumber();
  Surface components(Surface base);  // any number of components, changing a surface
  void appendTransform(TransformChain& chain);

  Tokens& tokens_;
  SurfaceTable& surfaces_;
  ImageLibrary& images_;
  Warn warn_;
  std::optional<UnreadName> unread_;
};

}  // namespace rayshade
