// What a parallel render is asked for: how many tasks, how space is divided, what travels, how long to wait.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

#include "pvm/messages/control.h"
#include "pvm/schedule/process_mapping.h"

namespace rayshade {

// Into what voxels space is cut.
enum class Split : std::uint8_t {
  equal,     // of equal size (Reinhard & Jansen, section 3)
  cost,      // of equal predicted work
  balanced,  // of equal bytes, then of equal predicted work, with little that is held twice
};

struct HostOptions {
  Wishes wishes;
  std::uint32_t voxelsPerTask = 1;
  Split split = Split::balanced;
  std::uint32_t window = 0;         // samples on their way; 0: by the number of tasks
  std::uint32_t cells = 0;          // of the bin-tree, about; 0: by the size of the scene
  std::uint32_t tilePixels = 1024;  // of a pyramid, about
  DemandPolicy policy;
  std::uint32_t threads = 1;    // of a tracing task; 0: as many as its machine has cores
  bool dynamicShading = false;  // shade tasks chosen by how busy they are
  std::uint64_t seed = 0;
  bool mixedArithmetic = false;  // go on when hosts compute different bits
  int mostEarlyDeaths = 3;       // of one place in a row, before it was ready: its memory will not grow
  int mostSuccessions = 100;     // deaths after which the render is given up
  double pingAfter = 10;         // seconds of silence until a task is asked whether it lives
  double killAfter = 30;         // seconds of silence, asked and no answer, until it counts as hanging
  double patienceAtStart = 600;  // the same while tasks read their share of the model
};

// The render cannot go on: a program is missing, too many deaths, hosts that do not fit together.
class HostError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rayshade
