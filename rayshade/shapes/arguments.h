// The arguments of a keyword, as a shape, texture or light asks for them.
//
// The parser stands behind it.  A wrong argument never comes back here: the parser reports it with its place
// and leaves the statement.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "rayshade/base/color.h"
#include "rayshade/base/vec.h"
#include "rayshade/optics/surface.h"

namespace rayshade {

class Arguments {
 public:
  virtual double number() = 0;                     // a signed number or a parenthesised expression
  virtual bool numberFollows() = 0;                // is the next token the start of a number?
  virtual bool accept(std::string_view word) = 0;  // takes the next word if it is this keyword
  virtual bool fileNameFollows() = 0;              // is the next token a name that is not a keyword?
  virtual std::string inputFile() = 0;             // takes the name of a file to be read: where it is found
  virtual Surface surface() = 0;                   // a surface-spec: a name, cursurf, components
  // Something is odd but the scene goes on (`file:line: warning: ...`).
  virtual void warn(const std::string& message) = 0;
  // The statement is wrong; does not return.
  [[noreturn]] virtual void fail(const std::string& message) = 0;

  int integer();  // cut towards zero; out of the range of int is an error
  Vec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  Color color() {
    const double r = number(), g = number(), b = number();
    return {r, g, b};
  }

 protected:
  ~Arguments() = default;
};

inline int Arguments::integer() {
  const double value = number();
  if (!(value > -2147483649.0 && value < 2147483648.0)) fail("a whole number is out of range");
  return static_cast<int>(value);
}

}  // namespace rayshade
