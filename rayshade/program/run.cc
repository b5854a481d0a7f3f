// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/program/run.h"

#include <sys/resource.h>

#include <cstdio>
#include <new>
#include <utility>

#include "rayshade/base/error.h"
#include "rayshade/base/interruption.h"
#include "rayshade/base/memory.h"

namespace rayshade {
namespace {

constexpr int kBadInput = 1, kBadCommandLine = 2;

// Memory for the message that there is no more.  Untouched, it costs no page.  The operators are called by name: of an
// expression `new` that nobody uses compilers leave nothing.
class Reserve {
 public:
  Reserve() = default;
  Reserve(const Reserve&) = delete;
  Reserve& operator=(const Reserve&) = delete;
  ~Reserve() { release(); }
  void release() { ::operator delete(std::exchange(bytes_, nullptr)); }

 private:
  void* bytes_ = ::operator new (std::size_t{1} << 20);
};

// A signal may come to light as something else, as a file that could not be written.
int endsWith(int status, const std::string& name, const std::string& message) {
  std::fprintf(stderr, "%s\n", (interrupted() ? name + interruptionText() : message).c_str());
  if (interrupted()) dieOfInterruption();
  return status;
}

}  // namespace

std::string objectsAndBytes(std::uint64_t objects, std::uint64_t bytes) {
  return std::to_string(objects) + " objects (" + sayBytes(static_cast<double>(bytes)) + ")";
}

std::string memoryOfProcess() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return "the process has " + sayBytes(1024.0 * static_cast<double>(usage.ru_maxrss));
}

int runProgram(const std::string& program, const std::function<int()>& work,
               const std::function<std::string()>& memory) {
  const std::string name = program + ": ";
  Reserve reserve;
  try {
    return work();
  } catch (const SceneError& error) {  // names the scene
    return endsWith(kBadInput, name, error.what());
  } catch (const CommandLineError& error) {
    return endsWith(kBadCommandLine, name, name + error.what());
  } catch (const std::bad_alloc&) {
    reserve.release();
    return endsWith(kBadInput, name, name + "not enough memory " + memory());
  } catch (const std::exception& error) {
    return endsWith(kBadInput, name, name + error.what());
  }
}

}  // namespace rayshade
