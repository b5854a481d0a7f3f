// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/expression_reader.h"

#include <cmath>
#include <optional>

namespace rayshade {
namespace {

struct Function {
  std::string_view name;
  Operation operation;
  std::size_t arguments;
};

constexpr Function kFunctions[] = {
    {"sin", Operation::sine, 1},        {"cos", Operation::cosine, 1},
    {"tan", Operation::tangent, 1},     {"asin", Operation::arcsine, 1},
    {"acos", Operation::arccosine, 1},  {"atan", Operation::arctangent, 1},
    {"sqrt", Operation::squareRoot, 1}, {"hypot", Operation::hypotenuse, 2},
    {"linear", Operation::linear, 4},
};

const Function* findFunction(std::string_view name) {
  for (const Function& f : kFunctions)
    if (f.name == name) return &f;
  return nullptr;
}

// What waits on the stack for its right operand or its closing parenthesis.
struct Pending {
  enum class Kind : std::uint8_t { binary, negation, parenthesis, call } kind = Kind::parenthesis;
  Operation operation = Operation::add;
  int strength = 0;                    // of the binding; parentheses have none
  const Function* function = nullptr;  // of a call
  std::size_t arguments = 0;           // of a call: complete ones so far
  TokenPlace place;
};

constexpr int kSum = 1, kProduct = 2, kSign = 3, kPower = 4;

struct Operator {
  Operation operation;
  int strength;
};

std::optional<Operator> binaryOperator(char symbol) {
  switch (symbol) {
    case '+':
      return Operator{Operation::add, kSum};
    case '-':
      return Operator{Operation::subtract, kSum};
    case '*':
      return Operator{Operation::multiply, kProduct};
    case '/':
      return Operator{Operation::divide, kProduct};
    case '%':
      return Operator{Operation::modulo, kProduct};
    case '^':
      return Operator{Operation::power, kPower};
    default:
      return std::nullopt;
  }
}

class ExpressionReader {
 public:
  ExpressionReader(Tokens& tokens, const Variables& variables) : tokens_(tokens), variables_(variables) {}

  Expression read() {
    do {
      if (operandWanted_) {
        readOperand();
      } else {
        readOperator();
      }
    } while (!pending_.empty());
    Expression whole = std::move(operands_.back());
    if (!whole.varies() && !std::isfinite(whole.postfix[0].value))
      throw Fault{"the value of this expression is not a finite number", start_};
    tokens_.advance();  // the last parenthesis; what is behind it is nobody's fault in here
    return whole;
  }

 private:
  bool symbolIs(char symbol) const {
    return tokens_.current().kind == Token::Kind::symbol && tokens_.current().symbol == symbol;
  }

  [[noreturn]] void fault(std::string message) const {
    throw Fault{std::move(message), tokens_.current().place};
  }

  void readOperand() {
    const Token token = tokens_.current();
    switch (token.kind) {
      case Token::Kind::number:
        pushOperand(constantExpression(token.value));
        tokens_.advance();
        return;
      case Token::Kind::word:
        return readName();
      case Token::Kind::symbol:
        if (token.symbol == '(') {
          push({Pending::Kind::parenthesis, {}, 0, nullptr, 0, token.place});
          tokens_.advance();
          return;
        }
        if (token.symbol == '-') {
          push({Pending::Kind::negation, Operation::negate, kSign, nullptr, 0, token.place});
          tokens_.advance();
          return;
        }
        if (token.symbol == '+') return tokens_.advance();
        fault(std::string("a number is expected here, not `") + token.symbol + "`");
      case Token::Kind::end:
        fault("the text ends inside of an expression");
    }
  }

  void readName() {
    const Token token = tokens_.current();
    const std::string name(tokens_.text());
    if (const Function* function = findFunction(name)) {
      tokens_.advance();
      if (!symbolIs('(')) fault("`" + name + "` is a function: a `(` is expected here");
      push({Pending::Kind::call, function->operation, 0, function, 0, token.place});
      tokens_.advance();
      return;
    }
    const Expression* value = variables_.find(name);
    if (value == nullptr) {
      std::string message = "`" + name + "` is not defined";
      if (token.keyword.word != Word::none) message = "the reserved word `" + name + "` is not a variable";
      if (name.find('-') != std::string::npos) message += " (a minus needs a blank before it)";
      fault(message);
    }
    pushOperand(*value);
    tokens_.advance();
  }

  void readOperator() {
    const Token token = tokens_.current();
    if (token.kind == Token::Kind::end) fault("the text ends inside of an expression: `)` is missing");
    if (token.kind != Token::Kind::symbol) fault("an operator or `)` is expected here");
    if (token.symbol == ')') return close();
    if (token.symbol == ',') return nextArgument();
    const auto next = binaryOperator(token.symbol);
    if (!next) fault(std::string("an operator is expected here, not `") + token.symbol + "`");
    // ^ binds to the right, the others to the left.
    applyWhile(next->strength + (next->operation == Operation::power ? 1 : 0));
    push({Pending::Kind::binary, next->operation, next->strength, nullptr, 0, token.place});
    operandWanted_ = true;
    tokens_.advance();
  }

  void nextArgument() {
    applyWhile(kSum);
    Pending& open = pending_.back();
    if (open.kind != Pending::Kind::call) fault("a `,` outside of a function's arguments");
    ++open.arguments;
    if (open.arguments >= open.function->arguments) faultArity(open);
    operandWanted_ = true;
    tokens_.advance();
  }

  void close() {
    applyWhile(kSum);
    const Pending open = pending_.back();
    if (open.kind == Pending::Kind::call) {
      if (open.arguments + 1 != open.function->arguments) faultArity(open);
      apply(open.operation, open.function->arguments, open.place);
    }
    pending_.pop_back();
    operandWanted_ = false;
    if (!pending_.empty()) tokens_.advance();
  }

  [[noreturn]] void faultArity(const Pending& call) const {
    const std::size_t wanted = call.function->arguments;
    throw Fault{"`" + std::string(call.function->name) + "` takes " + std::to_string(wanted) +
                    (wanted == 1 ? " argument" : " arguments"),
                call.place};
  }

  // Applies what binds at least as strongly as the operator to come, up to the last open parenthesis.
  void applyWhile(int strength) {
    while (pending_.back().strength >= strength) {
      const Pending top = pending_.back();
      pending_.pop_back();
      apply(top.operation, top.kind == Pending::Kind::binary ? 2 : 1, top.place);
    }
  }

  // Replaces the last operands by the result of an operation on them.
  void apply(Operation operation, std::size_t count, const TokenPlace& place) {
    const std::size_t first = operands_.size() - count;
    const Expression& last = operands_.back();
    if (operation == Operation::modulo && !last.varies() && std::abs(last.postfix[0].value) < 1)
      throw Fault{"% by zero", place};
    Expression joined = std::move(operands_[first]);
    for (std::size_t i = first + 1; i < operands_.size(); ++i)
      joined.postfix.insert(joined.postfix.end(), operands_[i].postfix.begin(), operands_[i].postfix.end());
    joined.postfix.push_back({operation, 0});
    if (joined.postfix.size() > kLongestExpression)
      throw Fault{"an expression of more than 1000 operations that depends on time", place};
    operands_.resize(first);
    operands_.push_back(joined.varies() ? std::move(joined) : constantExpression(evaluate(joined, {})));
  }

  void push(const Pending& pending) {
    if (pending_.size() == kDeepestExpression)
      throw Fault{"an expression nested more than 1000000 deep", pending.place};
    pending_.push_back(pending);
  }

  void pushOperand(Expression value) {
    operands_.push_back(std::move(value));
    operandWanted_ = false;
  }

  Tokens& tokens_;
  const Variables& variables_;
  const TokenPlace start_ = tokens_.current().place;
  std::vector<Expression> operands_;
  std::vector<Pending> pending_;
  bool operandWanted_ = true;
};

}  // namespace

// The constants have the digits of rayshade4, not more: scenes depend on them.
Variables::Variables() {
  values_["pi"] = constantExpression(3.141592);
  values_["dtor"] = constantExpression(0.017453);
  values_["rtod"] = constantExpression(57.29578);
  values_["time"] = {{{Operation::time, 0}}};
  values_["frame"] = {{{Operation::frame, 0}}};
}

const Expression* Variables::find(std::string_view name) const {
  const auto at = values_.find(name);
  return at == values_.end() ? nullptr : &at->second;
}

bool Variables::add(const std::string& name, Expression value) {
  return findFunction(name) == nullptr && values_.try_emplace(name, std::move(value)).second;
}

Expression readExpression(Tokens& tokens, const Variables& variables) {
  return ExpressionReader(tokens, variables).read();
}

}  // namespace rayshade
