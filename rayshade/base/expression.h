// An arithmetic expression of the scene language, compiled to postfix order.
//
// Only `time` and `frame` are left as variables, so its value is a pure function of the moment.  Constant
// expressions are folded while the scene is read (scene/expression.h); what gets here is evaluated per ray.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "rayshade/base/archive.h"

namespace rayshade {

// A moment of an animation: scene time in the scene's own unit, and the number of the frame.
struct Moment {
  double time = 0;
  std::int32_t frame = 0;
};

enum class Operation : std::uint8_t {
  constant,  // pushes `value`
  time,
  frame,
  add,
  subtract,
  multiply,
  divide,
  modulo,
  power,
  negate,
  sine,
  cosine,
  tangent,
  arcsine,
  arccosine,
  arctangent,
  squareRoot,
  hypotenuse,
  linear,  // linear(t0, v0, t1, v1) at the current time
};

struct Instruction {
  Operation operation = Operation::constant;
  double value = 0;
};

struct Expression {
  std::vector<Instruction> postfix;

  bool varies() const;  // mentions time or frame (linear() does so without being told)
  bool valid() const;   // each operation finds its operands and one value is left: ask after decoding
};

// The value at a moment.  Requires valid().  Never traps: x % 0 is 0 here, the parser refuses it beforehand.
double evaluate(const Expression& expression, const Moment& moment);

inline Expression constantExpression(double value) { return {{{Operation::constant, value}}}; }

template <class Archive>
void serialize(Archive& archive, Moment& m) {
  archive(m.time, m.frame);
}
template <class Archive>
void serialize(Archive& archive, Instruction& i) {
  archive(i.operation, i.value);
}
template <class Archive>
void serialize(Archive& archive, Expression& e) {
  archive(e.postfix);
  if constexpr (Archive::kReading) {
    if (!e.valid()) {
      e = constantExpression(0);
      archive.fail();
    }
  }
}

}  // namespace rayshade
