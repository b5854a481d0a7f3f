// guarded: reads text of others
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/language/expression_reader.h"

#include <gtest/gtest.h>

#include "rayshade/base/elementary.h"

namespace rayshade {
namespace {

Expression read(const std::string& text, const Variables& variables = {}) {
  std::size_t at = 0;
  Tokens tokens(
      [&](char* to, std::size_t most) {
        const std::size_t count = text.copy(to, most, at);
        at += count;
        return count;
      },
      "scene.ray");
  tokens.advance();
  return readExpression(tokens, variables);
}

double valueOf(const std::string& text) {
  const Expression e = read(text);
  EXPECT_EQ(e.postfix.size(), 1u) << text << " is not folded";
  return e.postfix[0].value;
}

// "column: message"
std::string faultOf(const std::string& text, const Variables& variables = {}) {
  try {
    read(text, variables);
  } catch (const Fault& fault) {
    return std::to_string(fault.place.offset + 1) + ": " + fault.message;
  }
  return "no fault";
}

TEST(Expression, KnowsTheStrengthOfOperators) {
  EXPECT_EQ(valueOf("(2 + 3 * 4)"), 14);
  EXPECT_EQ(valueOf("(8 / 2 / 2 + 9 - 3 - 2)"), 6);
  EXPECT_EQ(valueOf("(2 ^ 3 ^ 2)"), 512);
  EXPECT_EQ(valueOf("(-2 ^ 2)"), -4);
  EXPECT_EQ(valueOf("(2 ^ -1)"), 0.5);
  EXPECT_EQ(valueOf("(2 ^ -1 * 3)"), 1.5);
  EXPECT_EQ(valueOf("(-2 * 3)"), -6);
  EXPECT_EQ(valueOf("(-2 + 3 - -4)"), 5);
  EXPECT_EQ(valueOf("(- - 2)"), 2);
  EXPECT_EQ(valueOf("(+3)"), 3);
  EXPECT_EQ(valueOf("((1 + 2) * (3 + 4))"), 21);
  EXPECT_EQ(valueOf("(7 - 5 + 1)"), 3);
  EXPECT_EQ(valueOf("(3 * 2 ^ 3)"), 24);
}

TEST(Expression, CutsOperandsOfTheRemainder) {
  EXPECT_EQ(valueOf("(7 % 4)"), 3);
  EXPECT_EQ(valueOf("(7.9 % 4.9)"), 3);
  EXPECT_EQ(valueOf("(-7 % 4)"), -3);
  EXPECT_EQ(valueOf("(2 * 7 % 4)"), 2);
}

TEST(Expression, HasTheConstantsOfRayshade) {
  EXPECT_EQ(valueOf("(pi)"), 3.141592);
  EXPECT_EQ(valueOf("(dtor)"), 0.017453);
  EXPECT_EQ(valueOf("(rtod)"), 57.29578);
}

TEST(Expression, CallsFunctions) {
  EXPECT_EQ(valueOf("(sqrt(16))"), 4);
  EXPECT_EQ(valueOf("(hypot(3, 4))"), 5);
  EXPECT_EQ(valueOf("(cos(0) + sin(0) + tan(0))"), 1);
  EXPECT_EQ(valueOf("(atan(1))"), elementary::atan(1));
  EXPECT_EQ(valueOf("(asin(.5) + acos(.5))"), elementary::asin(.5) + elementary::acos(.5));
  EXPECT_EQ(valueOf("(hypot(1 + 2, (sqrt(16))) ^ 2)"), 25);
}

TEST(Expression, DependsOnTimeAndFrame) {
  const Expression e = read("(time * 2 + frame)");
  EXPECT_TRUE(e.varies());
  EXPECT_EQ(evaluate(e, {0.25, 3}), 3.5);
}

TEST(Expression, MakesLinearDependOnTime) {
  const Expression e = read("(linear(1, 10, 3, 20))");
  EXPECT_TRUE(e.varies());
  EXPECT_EQ(evaluate(e, {0, 0}), 10);
  EXPECT_EQ(evaluate(e, {2, 0}), 15);
  EXPECT_EQ(evaluate(e, {9, 0}), 20);
}

TEST(Expression, FoldsTheConstantParts) { EXPECT_EQ(read("((1 + 2 * 3) * time)").postfix.size(), 3u); }

TEST(Expression, UsesVariables) {
  Variables variables;
  EXPECT_TRUE(variables.add("width", constantExpression(3)));
  EXPECT_TRUE(variables.add("spin", read("(time * 90)")));
  EXPECT_EQ(evaluate(read("(width * spin)", variables), {2, 0}), 540);
}

TEST(Expression, ProtectsWhatIsDefined) {
  Variables variables;
  EXPECT_TRUE(variables.add("a", constantExpression(1)));
  EXPECT_FALSE(variables.add("a", constantExpression(2)));
  EXPECT_FALSE(variables.add("pi", constantExpression(3)));
  EXPECT_FALSE(variables.add("time", constantExpression(3)));
  EXPECT_FALSE(variables.add("sin", constantExpression(3)));
}

TEST(Expression, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(faultOf("(radius * 2)"), "2: `radius` is not defined");
  EXPECT_EQ(faultOf("(length-1)"), "2: `length-1` is not defined (a minus needs a blank before it)");
  EXPECT_EQ(faultOf("(2 * sphere)"), "6: the reserved word `sphere` is not a variable");
  EXPECT_EQ(faultOf("(sin(1, 2))"), "2: `sin` takes 1 argument");
  EXPECT_EQ(faultOf("(hypot(1))"), "2: `hypot` takes 2 arguments");
  EXPECT_EQ(faultOf("(linear(1, 2, 3, 4, 5))"), "2: `linear` takes 4 arguments");
  EXPECT_EQ(faultOf("(sin)"), "5: `sin` is a function: a `(` is expected here");
  EXPECT_EQ(faultOf("(7 % 0 + 1)"), "4: % by zero");
  EXPECT_EQ(faultOf("(7 % 0.5)"), "4: % by zero");
  EXPECT_EQ(faultOf("(time % 0)"), "7: % by zero");
  EXPECT_EQ(faultOf("(1 2)"), "4: an operator or `)` is expected here");
  EXPECT_EQ(faultOf("(1 +)"), "5: a number is expected here, not `)`");
  EXPECT_EQ(faultOf("()"), "2: a number is expected here, not `)`");
  EXPECT_EQ(faultOf("(1, 2)"), "3: a `,` outside of a function's arguments");
  EXPECT_EQ(faultOf("(1 + (2)"), "9: the text ends inside of an expression: `)` is missing");
  EXPECT_EQ(faultOf("(1 +"), "5: the text ends inside of an expression");
}

TEST(Expression, RefusesValuesThatAreNoNumbers) {
  EXPECT_EQ(faultOf("(sqrt(-1))"), "1: the value of this expression is not a finite number");
  EXPECT_EQ(faultOf("(0 / 0)"), "1: the value of this expression is not a finite number");
  EXPECT_EQ(faultOf("(1e300 * 1e300)"), "1: the value of this expression is not a finite number");
}

TEST(Expression, BearsDeepNesting) {
  const std::string open(100000, '('), close(100000, ')');
  EXPECT_EQ(valueOf(open + "1" + close), 1);
  EXPECT_NE(faultOf(std::string(1000002, '(')).find("nested"), std::string::npos);
}

TEST(Expression, DoesNotGrowWithoutLimit) {
  Variables variables;
  std::string last = "time", fault = "no fault";
  for (int i = 0; i < 60 && fault == "no fault"; ++i) {
    const std::string text = "(" + last + " + " + last + ")";
    fault = faultOf(text, variables);
    last = "v" + std::to_string(i);
    if (fault == "no fault") variables.add(last, read(text, variables));
  }
  EXPECT_NE(fault.find("more than 1000 operations"), std::string::npos) << fault;
}

}  // namespace
}  // namespace rayshade
