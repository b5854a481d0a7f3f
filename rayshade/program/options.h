// The command line of Rayshade 4, as far as it concerns the picture, and what has been added to it.
//
// The sequential program and the host task share it.  Options override what the scene file says.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rayshade/image/picture_file.h"
#include "rayshade/language/parser.h"

namespace CLI {
class App;  // only those who declare or parse options need the whole of it, which takes seconds to compile
}

namespace rayshade {

struct Options {
  ParseOptions parse;      // the scene file among it
  std::string outputFile;  // -O; empty: what the scene says, else standard output
  std::uint64_t seed = 0;
  bool quiet = false, verbose = false;
  std::optional<unsigned> threads;  // that trace
  std::string verboseFile;          // -V: the report goes there
  std::string eventsFile;           // what was done when goes there

  // What is said on the command line; nothing: the scene file decides.
  std::vector<int> resolution, window;
  std::vector<double> crop, cutoff, contrast;
  std::optional<int> samples, maxDepth, frames, firstFrame, reportEvery;
  std::optional<double> gamma, eyeSeparation;
  std::string sampling = "nets", refinement;
  bool gaussian = false, toggleJitter = false, noShadows = false, opaqueShadows = false, preview = false;
  bool leftEye = false, rightEye = false, toggleShadowCache = false;
  bool sixteenBit = false;
};

// Declares the options in an application; what they say arrives in `options` when it parses.
void declareOptions(CLI::App& app, Options& options);

// Puts what was said over what the scene file says.  Throws SceneError where the two do not go together.
void applyOptions(const Options& options, SceneHead& head);

// How many threads trace: what was said, else as many as there are cores.
unsigned threadsOf(const Options& options);

// The name of the scene in messages.
std::string sceneName(const Options& options);

// Every so many rows a line is to say how far it is; 0: never.
std::int32_t rowsBetweenLines(const Options& options, const SceneHead& head);
// Is there to be a report at the end, and into which file; empty: to the terminal, or none.
bool reportWanted(const Options& options, const SceneHead& head);
std::string reportFile(const Options& options, const SceneHead& head);

}  // namespace rayshade
