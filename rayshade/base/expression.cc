// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/expression.h"

#include <cmath>

#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

int operandCount(Operation operation) {
  switch (operation) {
    case Operation::constant:
    case Operation::time:
    case Operation::frame:
      return 0;
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::divide:
    case Operation::modulo:
    case Operation::power:
    case Operation::hypotenuse:
      return 2;
    case Operation::linear:
      return 4;
    default:
      return operation < Operation::linear ? 1 : -1;
  }
}

// Both operands cut to integers and the remainder of C, as rayshade has it.
double remainder(double a, double b) {
  if (!(std::abs(a) < 9e18) || !(std::abs(b) < 9e18) || std::abs(b) < 1) return 0;
  return static_cast<double>(static_cast<long long>(a) % static_cast<long long>(b));
}

double linearAt(double time, double t0, double v0, double t1, double v1) {
  if (time < t0) return v0;
  if (time > t1) return v1;
  if (t0 == t1) return v0;
  return v0 + (v1 - v0) * (time - t0) / (t1 - t0);
}

}  // namespace

bool Expression::varies() const {
  for (const Instruction& i : postfix) {
    if (i.operation == Operation::time || i.operation == Operation::frame || i.operation == Operation::linear)
      return true;
  }
  return false;
}

bool Expression::valid() const {
  long depth = 0;
  for (const Instruction& i : postfix) {
    const int operands = operandCount(i.operation);
    if (operands < 0 || depth < operands) return false;
    depth += 1 - operands;
  }
  return depth == 1;
}

double evaluate(const Expression& expression, const Moment& moment) {
  if (expression.postfix.size() == 1 && expression.postfix[0].operation == Operation::constant)
    return expression.postfix[0].value;
  std::vector<double> stack;
  stack.reserve(expression.postfix.size());
  auto pop = [&stack] {
    const double top = stack.back();
    stack.pop_back();
    return top;
  };
  for (const Instruction& i : expression.postfix) {
    if (i.operation == Operation::linear) {
      const double v1 = pop(), t1 = pop(), v0 = pop(), t0 = pop();
      stack.push_back(linearAt(moment.time, t0, v0, t1, v1));
      continue;
    }
    const int operands = operandCount(i.operation);
    const double b = operands == 2 ? pop() : 0;
    const double a = operands >= 1 ? pop() : 0;
    switch (i.operation) {
      case Operation::constant:
        stack.push_back(i.value);
        break;
      case Operation::time:
        stack.push_back(moment.time);
        break;
      case Operation::frame:
        stack.push_back(moment.frame);
        break;
      case Operation::add:
        stack.push_back(a + b);
        break;
      case Operation::subtract:
        stack.push_back(a - b);
        break;
      case Operation::multiply:
        stack.push_back(a * b);
        break;
      case Operation::divide:
        stack.push_back(a / b);
        break;
      case Operation::modulo:
        stack.push_back(remainder(a, b));
        break;
      case Operation::power:
        stack.push_back(elementary::pow(a, b));
        break;
      case Operation::negate:
        stack.push_back(-a);
        break;
      case Operation::sine:
        stack.push_back(elementary::sin(a));
        break;
      case Operation::cosine:
        stack.push_back(elementary::cos(a));
        break;
      case Operation::tangent:
        stack.push_back(elementary::tan(a));
        break;
      case Operation::arcsine:
        stack.push_back(elementary::asin(a));
        break;
      case Operation::arccosine:
        stack.push_back(elementary::acos(a));
        break;
      case Operation::arctangent:
        stack.push_back(elementary::atan(a));
        break;
      case Operation::squareRoot:
        stack.push_back(std::sqrt(a));
        break;
      case Operation::hypotenuse:
        stack.push_back(elementary::hypot(a, b));
        break;
      case Operation::linear:
        break;
    }
  }
  return stack.back();
}

}  // namespace rayshade
