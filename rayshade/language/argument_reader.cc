// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/argument_reader.h"

#include <array>
#include <utility>

#include "rayshade/base/file.h"

namespace rayshade {
namespace {

bool finite(const Matrix& m) { return isFinite(m.x) && isFinite(m.y) && isFinite(m.z) && isFinite(m.origin); }

}  // namespace

void ArgumentReader::unexpected(std::string_view wanted) const {
  std::string found = "the end of the text";
  if (token().kind != Token::Kind::end) found = "`" + std::string(tokens_.text()) + "`";
  throw Fault{std::string(wanted) + " is expected here, not " + found, token().place};
}

bool ArgumentReader::symbolFollows(char symbol) const {
  return token().kind == Token::Kind::symbol && token().symbol == symbol;
}

bool ArgumentReader::numberFollows() {
  return token().kind == Token::Kind::number || symbolFollows('-') || symbolFollows('+') ||
         symbolFollows('(');
}

double ArgumentReader::take(const Range& range, bool whole) {
  const TokenPlace place = token().place;
  double value = unchecked();
  if (whole) value = std::trunc(value);
  if (!range.holds(value)) throw Fault{outOfRange(value, range, whole), place};
  return value;
}

double ArgumentReader::unchecked() {
  if (!symbolFollows('(')) return signedNumber();
  const TokenPlace place = token().place;
  const Expression value = expression();
  if (value.varies()) throw Fault{"this depends on time: only transforms and variables may", place};
  return value.postfix[0].value;
}

Expression ArgumentReader::expression() {
  if (symbolFollows('(')) return readExpression(tokens_, variables);
  return constantExpression(signedNumber());
}

double ArgumentReader::signedNumber() {
  const bool negative = symbolFollows('-');
  if (negative || symbolFollows('+')) tokens_.advance();
  if (token().kind != Token::Kind::number) unexpected("a number");
  const double value = token().value;
  tokens_.advance();
  return negative ? -value : value;
}

std::string ArgumentReader::inputFile() {
  UnreadName name;
  if (unread_) {
    name = *std::exchange(unread_, std::nullopt);
  } else {
    name.place = token().place;
    name.text = tokens_.fileName();
  }
  auto found = findFile(name.text, tokens_.describe(name.place).file);
  if (const auto* problem = std::get_if<FileProblem>(&found)) throw Fault{problem->message, name.place};
  return std::get<std::string>(std::move(found));
}

std::shared_ptr<const Image> ArgumentReader::inputImage() {
  auto read = images_.read(inputFile());
  if (const auto* problem = std::get_if<FileProblem>(&read)) fail(problem->message);
  return std::get<std::shared_ptr<const Image>>(std::move(read));
}

bool ArgumentReader::accept(std::string_view word) {
  if (token().kind != Token::Kind::word || tokens_.text() != word) return false;
  tokens_.advance();
  return true;
}

std::string ArgumentReader::name(std::string_view ofWhat) {
  if (token().kind == Token::Kind::word && !nameFollows())
    throw Fault{"`" + std::string(tokens_.text()) + "` is a reserved word and cannot be the name of " +
                    std::string(ofWhat),
                token().place};
  if (!nameFollows()) unexpected("the name of " + std::string(ofWhat));
  std::string text(tokens_.text());
  tokens_.advance();
  return text;
}

bool ArgumentReader::surfaceFollows() const {
  return nameFollows() || word() == Word::cursurf || isComponent(word());
}

Surface ArgumentReader::surface() {
  const TokenPlace place = token().place;
  Surface base;
  if (nameFollows()) {
    const Surface* named = surfaces_.find(tokens_.text());
    if (named == nullptr) throw Fault{"undefined surface `" + std::string(tokens_.text()) + "`", place};
    base = *named;
    tokens_.advance();
  } else if (word() == Word::cursurf) {
    base = current.surface;
    tokens_.advance();
  } else if (!isComponent(word())) {
    unexpected("a surface");
  }
  return components(base);
}

BoundSurface ArgumentReader::boundSurface(SceneSink& sink) {
  if (!nameFollows()) return surfaces_.bind(surface(), sink);
  const std::string name(tokens_.text());
  const TokenPlace place = token().place;
  tokens_.advance();
  return boundSurface(name, place, sink);
}

// A named surface, or the copy that the components behind its name make of it.
BoundSurface ArgumentReader::boundSurface(std::string_view name, const TokenPlace& place, SceneSink& sink) {
  if (!surfaces_.known(name)) throw Fault{"undefined surface `" + std::string(name) + "`", place};
  const BoundSurface named = surfaces_.bindName(name, sink);
  return isComponent(word()) ? surfaces_.bind(components(named.surface), sink) : named;
}

Surface ArgumentReader::components(Surface s) {
  const TokenPlace place = token().place;
  while (isComponent(word())) {
    const Word component = word();
    tokens_.advance();
    switch (component) {
      case Word::ambient:
        s.ambient = color();
        break;
      case Word::body:
        s.body = color();
        break;
      case Word::diffuse:
        s.diffuse = color();
        break;
      case Word::extinct:
        s.extinct = number(kShare);
        break;
      case Word::index:
        s.index = number();
        break;
      case Word::noshadow:
        s.noShadow = true;
        break;
      case Word::reflect:
        s.reflect = number(kFactor);
        break;
      case Word::specpow:
        s.specularPower = number(kExponent);
        break;
      case Word::specular:
        s.specular = color();
        break;
      case Word::translucency:
        s.translucency = number(kFactor);
        s.translucent = color();
        s.translucentPower = number(kExponent);
        break;
      default:
        s.transparency = number(kFactor);
        break;
    }
  }
  if (s.transparency > kNegligible && !(s.index > 0))
    throw Fault{"a transparent surface needs an index of refraction above 0", place};
  return s;
}

TransformChain ArgumentReader::transforms() {
  TransformChain chain;
  const TokenPlace place = token().place;
  while (isTransform(word())) appendTransform(chain);
  for (const auto& step : chain.steps)
    if (const Affine* constant = std::get_if<Affine>(&step); constant && !isInvertible(*constant))
      throw Fault{"these transforms together lose all digits: there is no way back", place};
  return chain;
}

// differs from rayshade4: only what has no inverse in doubles is singular; there is no limit to small scales.
void ArgumentReader::appendTransform(TransformChain& chain) {
  using Kind = MovingStep::Kind;
  const TokenPlace place = token().place;
  const Word word = this->word();
  tokens_.advance();
  MovingStep step;
  step.kind = word == Word::translate ? Kind::translate
              : word == Word::scale   ? Kind::scale
              : word == Word::rotate  ? Kind::rotate
                                      : Kind::transform;
  std::size_t count = word == Word::rotate ? 4 : word == Word::transform ? 9 : 3;
  bool moves = false;
  for (std::size_t i = 0; i < count; ++i) {
    step.arguments.push_back(expression());
    moves = moves || step.arguments.back().varies();
    if (i == 8 && count == 9 && numberFollows()) count = 12;
  }
  if (moves) return chain.append(std::move(step));

  auto value = [&step](std::size_t i) { return step.arguments[i].postfix[0].value; };
  if (step.kind == Kind::rotate && value(0) == 0 && value(1) == 0 && value(2) == 0)
    return warn_(place, "a rotation about the axis 0 0 0 turns nothing");
  const std::optional<Affine> affine = stepAt(step, {});
  if (!affine) throw Fault{"a singular transform: it flattens space", place};
  chain.append(*affine);
  const Affine& folded = std::get<Affine>(chain.steps.back());
  if (!finite(folded.forward) || !finite(folded.inverse))
    throw Fault{"the transforms up to here leave the range of numbers", place};
}

}  // namespace rayshade
