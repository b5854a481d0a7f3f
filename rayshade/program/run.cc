// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/run.h"

#include <cstdio>

#include "rayshade/base/error.h"
#include "rayshade/base/interruption.h"

namespace rayshade {
namespace {

constexpr int kBadInput = 1, kBadCommandLine = 2;

int endsWith(int status, const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  // A signal may come to light as something else, as a file that could not be written.
  if (interrupted()) dieOfInterruption();
  return status;
}

}  // namespace

int runProgram(const std::string& name, const std::function<int()>& work) {
  try {
    return work();
  } catch (const SceneError& error) {  // names the scene
    return endsWith(kBadInput, error.what());
  } catch (const CommandLineError& error) {
    return endsWith(kBadCommandLine, name + ": " + error.what());
  } catch (const std::exception& error) {
    return endsWith(kBadInput, name + ": " + error.what());
  }
}

}  // namespace rayshade
