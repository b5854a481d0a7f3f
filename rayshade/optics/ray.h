// A ray of light, followed backwards.
//
// It never changes its origin while it travels: all distances t are measured from where it was born, in world
// units, so every task computes the same t for the same object whatever way the ray came.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/base/color.h"
#include "rayshade/base/expression.h"
#include "rayshade/base/inline_vector.h"
#include "rayshade/base/random.h"
#include "rayshade/base/vec.h"

namespace rayshade {

// What a ray can be inside of.
struct Medium {
  double index = 1;    // of refraction
  double extinct = 1;  // share of the light that is left after one unit of distance
};
using MediumStack = InlineVector<Medium, 2>;  // innermost last; empty: the atmosphere

struct Ray {
  Ray() {
  }  // written out, so that a new element of a list is not cleared before: that takes as long as the rest

  Vec3 origin, direction;       // |direction| = 1                                              [world units]
  Moment moment;                // for moving objects                                           [scene time]
  int depth = 0;                // 0 from the eye, +1 per reflection or refraction
  int sample = 0;               // sample number inside the pixel: stratum of lights, lens and gloss
  RandomKey key{};              // hash of the path so far
  Color contribution = kWhite;  // weight in the pixel; what weighs too little is not followed
  double extinct = 1;           // what it brings back is multiplied by extinct^distance
  MediumStack media;
};

// A ray in the space of an object.  t along it is t along the world ray times `scale`.
struct LocalRay {
  Vec3 origin, direction;  // |direction| = 1                                                [object units]
  double scale = 1;        // object units per world unit along this ray
};

template <class Archive>
void serialize(Archive& archive, Medium& m) {
  archive(m.index, m.extinct);
}
template <class Archive>
void serialize(Archive& archive, Ray& r) {
  archive(r.origin, r.direction, r.key);
  serializeSparse(archive, Usual{r.moment.time, 0.0}, Usual{r.moment.frame, 0}, Usual{r.depth, 0},
                  Usual{r.sample, 0}, Usual{r.contribution, kWhite}, Usual{r.extinct, 1.0},
                  Usual{r.media, MediumStack{}});
}

}  // namespace rayshade
