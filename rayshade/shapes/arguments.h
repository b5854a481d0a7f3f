// The arguments of a keyword, as a shape, texture or light asks for them.
//
// The parser stands behind it.  A wrong argument never comes back here: the parser reports it with its place
// and leaves the statement.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "rayshade/base/color.h"
#include "rayshade/base/range.h"
#include "rayshade/base/vec.h"
#include "rayshade/optics/surface.h"

namespace rayshade {

struct Image;

class Arguments {
 public:
  // A signed number or a parenthesised expression; out of its range it is wrong.
  double number(const Range& range = kAnyNumber) { return take(range, false); }
  // The same, cut towards zero.
  int integer(const Range& range = kAnyWholeNumber) { return static_cast<int>(take(range, true)); }
  virtual bool numberFollows() = 0;                // is the next token the start of a number?
  virtual bool accept(std::string_view word) = 0;  // takes the next word if it is this keyword
  virtual bool fileNameFollows() = 0;              // is the next token a name that is not a keyword?
  virtual std::string inputFile() = 0;             // takes the name of a file to be read: where it is found
  // The picture in the file whose name comes next; it fails if it cannot be read.
  virtual std::shared_ptr<const Image> inputImage() = 0;
  virtual Surface surface() = 0;  // a surface-spec: a name, cursurf, components
  // Something is odd but the scene goes on (`file:line: warning: ...`).
  virtual void warn(const std::string& message) = 0;
  // The statement is wrong; does not return.
  [[noreturn]] virtual void fail(const std::string& message) = 0;

  Vec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  Color color() {
    const double r = number(kFactor), g = number(kFactor), b = number(kFactor);
    return {r, g, b};
  }

 protected:
  virtual double take(const Range& range, bool whole) = 0;
  ~Arguments() = default;
};

// What is to be said of a number out of its range.
inline std::string outOfRange(double value, const Range& range, bool whole) {
  std::ostringstream text;
  text.precision(10);
  text << (whole ? "a whole number " : "a number ") << describe(range) << " is expected here, not " << value;
  return text.str();
}

}  // namespace rayshade
