// A CSG operation, ready to be asked for all crossings of a ray.
//
// Operations that are operands of each other are one tree here, whatever was between them - transforms, names, lists: operations
// above, leaves below.  A leaf is a shape, or a set of open surfaces that enclose something only together (a cylinder and its two
// discs).  A list, or what a name stands for, is the union of its members.  The leaves lie in an accelerator, so a ray asks those
// that it may meet before it hits, and no others: time grows with what a ray meets, not with the depth.
//
// Where one operation is an operand of another of its kind they become one with more operands:
//
//   union (union A B) C              = union A B C
//   difference (difference A B) C    = difference A (union B C) = difference A B C         the first against all others
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "rayshade/accel/bvh.h"
#include "rayshade/base/inline_vector.h"
#include "rayshade/scene/store.h"

namespace rayshade {

struct Region;
class Model;

struct Solid {
  // One step of the way from the operation down to a leaf; those that change neither space nor look are left out.
  struct Step {
    ObjectIndex object = kNone;
    std::uint32_t outer = kNone;  // the step before; kNone: the operation itself
    std::uint32_t space = kNone;  // the last step until here that leads into another space
  };
  // Where a leaf or an operation stands.
  struct Place {
    std::uint32_t operation = kNone;  // whose operand it is; kNone: the outermost operation
    bool first = true;                // its first operand: what a difference takes the others from
  };
  struct Operation {
    CsgOperation kind = CsgOperation::unite;
    Place place;
    std::uint32_t operands = 0;
  };
  struct Leaf {
    Place place;
    std::uint32_t step = kNone;      // its own
    Bounds bounds;                   // in the space of the operands: outside of them a ray is outside of it
    const Region* sheets = nullptr;  // the open surfaces inside of the step; null: the step is a shape
    bool endless = false;            // a ray that has entered may stay inside
    double tolerance = 0;  // its transforms may put it so far from where it should be       [its own units]
  };

  std::vector<Step> steps;
  std::vector<Operation> operations;         // each behind the one whose operand it is
  std::vector<Leaf> leaves;                  // in the order of the file
  Bvh bvh;                                   // of the leaves
  Bounds extent;                             // where the result can be
  std::vector<std::unique_ptr<Region>> own;  // sheets that are not all that is in a definition

  std::size_t bytes() const;
};

// The objects on the way to a leaf, outermost first; the last one is the leaf, or what holds its sheets.
InlineVector<ObjectIndex, 8> wayTo(const Solid& solid, const Solid::Leaf& leaf);

// `csg` is placed, and everything that it uses.  Empty if it has fewer than two operands.
Solid solidOf(const Model& model, const Csg& csg, const Exposure& exposure);

}  // namespace rayshade
