// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/daemon_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <thread>
#include <vector>

#include "pvm/link/daemon.h"
#include "pvm/link/daemon_files.h"
#include "rayshade/base/clock.h"
#include "rayshade/base/interruption.h"

namespace rayshade {
namespace {

constexpr double kStartSeconds = 15;  // for the daemon to say that it is ready
constexpr double kHaltSeconds = 5;    // for the daemon to end its tasks and itself
// As many as may be, for the daemon needs two for each task.  It uses select(), so it breaks above 1024, and closes each of
// them one by one.
constexpr rlim_t kDescriptors = 1024;

// In the child of fork(): nothing here allocates.
[[noreturn]] void becomeDaemon(const char* program, char* const* arguments, int output, pid_t parent) {
  setsid();                          // a Ctrl-C is for the renderer, which then ends us in order
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // on SIGTERM a pvmd halts its machine
  if (getppid() != parent) _exit(1);
  for (const int signal : {SIGTERM, SIGINT, SIGPIPE, SIGCHLD, SIGHUP}) ::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
    limit.rlim_cur = std::min(kDescriptors, limit.rlim_max);
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execv(program, arguments);
  _exit(127);
}

// What the daemon printed until it was ready, ended, or the time was over; ready = a line that begins with '/'.
std::string readUntilReady(int descriptor, bool& ready) {
  const double end = steadySeconds() + kStartSeconds;
  std::string text;
  for (ready = false; !ready && !interrupted() && steadySeconds() < end;) {
    pollfd wait{descriptor, POLLIN, 0};
    if (::poll(&wait, 1, 100) <= 0) continue;
    char buffer[512];
    const ssize_t n = read(descriptor, buffer, sizeof buffer);
    if (n <= 0) break;
    text.append(buffer, static_cast<std::size_t>(n));
    const std::size_t path = text[0] == '/' ? 0 : text.find("\n/");
    ready = path != std::string::npos && text.find('\n', path + 1) != std::string::npos;
  }
  return text;
}

std::string inOneLine(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string daemonProgram() {
  std::istringstream path(environment("PATH") + ":" + environment("PVM_ROOT") +
                          "/lib:/usr/bin:/usr/lib/pvm3/lib");
  for (std::string directory; std::getline(path, directory, ':');) {
    const std::string program = directory + "/pvmd";
    if (directory.starts_with('/') && access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

void startDaemon(const std::string& hostFile, const std::string& ownName, pid_t& daemon) {
  const std::string program = daemonProgram();
  if (program.empty()) throw MachineError("pvmd was not found: install PVM (Debian: apt-get install pvm)");
  removeLeftovers();

  std::vector<std::string> words{"pvmd"};
  if (!ownName.empty()) words.push_back("-n" + ownName);
  if (!hostFile.empty()) words.push_back(std::filesystem::absolute(hostFile).string());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw MachineError(std::string("no pipe for pvmd: ") + std::strerror(errno));
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) becomeDaemon(program.c_str(), arguments.data(), ends[1], parent);
  close(ends[1]);
  bool ready = false;
  const std::string printed = child > 0 ? readUntilReady(ends[0], ready) : std::strerror(errno);
  close(ends[0]);
  daemon = std::max(child, 0);
  checkInterruption();
  if (!ready) throw MachineError(program + " did not start: " + inOneLine(printed));
  if (lookForMachine() !=
      MachineState::alive)  // two were started at once, and the other has the address file
    throw MachineError("a second pvmd was started at the same moment: try again");
}

void endDaemon(pid_t daemon) {
  // It ends all tasks with SIGTERM, and may not have read yet that this one has left.
  struct sigaction before {};
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGTERM, &ignore, &before);
  kill(daemon, SIGTERM);
  const double end = steadySeconds() + kHaltSeconds;
  while (waitpid(daemon, nullptr, WNOHANG) == 0) {
    if (steadySeconds() > end) kill(daemon, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  sigaction(SIGTERM, &before, nullptr);
}

}  // namespace rayshade
