// Parenthesised expressions of the scene language, read and folded.
//
// Operators, loosest first:  + -    * / %    unary - +    ^  (to the right, -2^2 is -4).  Whatever does not
// depend on time is computed at once; the rest is compiled to base/expression.h.  Operators wait on a stack
// of our own, not on the machine's, so that no depth of parentheses can overflow it; the length of what
// depends on time is limited, because a few lines of `define` could double it again and again.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "rayshade/base/expression.h"
#include "rayshade/language/tokens.h"

namespace rayshade {

inline constexpr std::size_t kLongestExpression = 1000;       // instructions, of what depends on time
inline constexpr std::size_t kDeepestExpression = 1'000'000;  // parentheses and operators that wait

// Lets a map of strings be searched without making a string.
struct TextHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
};

template <class Value>
using NameMap = std::unordered_map<std::string, Value, TextHash, std::equal_to<>>;

// The variables that are known: pi, dtor, rtod, time, frame and what `define` has added.
class Variables {
 public:
  Variables();
  const Expression* find(std::string_view name) const;
  bool add(const std::string& name, Expression value);  // false when the name means something already

 private:
  NameMap<Expression> values_;
};

// Reads from the current token, a `(`, to the matching `)`.  Throws Fault.
Expression readExpression(Tokens& tokens, const Variables& variables);

}  // namespace rayshade
