// See virtual_machine.h.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/virtual_machine.h"

#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <pvm3.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>
#include <utility>

#include "pvm/link/daemon.h"
#include "rayshade/base/clock.h"
#include "rayshade/base/interruption.h"

namespace rayshade {
namespace {

constexpr double kFarewellSeconds = 0.2;  // for tasks that the daemon has just ended
constexpr double kJoinSeconds = 120;      // for all hosts; PVM itself gives up on one after 60

std::string whyHostFailed(const std::string& host, int code) {
  switch (code) {
    case PvmNoHost:
      return "its name is not known here: check the spelling, DNS or /etc/hosts";
    case PvmCantStart:
      return "no daemon could be started there: try `" +
             (environment("PVM_RSH").empty() ? std::string("ssh") : environment("PVM_RSH")) + " " + host +
             " pvmd -h` (PVM_RSH names the remote shell)";
    case PvmBadVersion:
      return "it has another version of PVM: install the same one";
    case PvmIPLoopback:
      return "this machine's own name means 127.x.x.x, where no other host can answer: name it by its "
             "network address";
    case PvmDSysErr:
      return "the daemon there failed: see pvml.* in its PVM_TMP or /tmp";
    default:
      return "PVM says error " + std::to_string(code);
  }
}

struct Silence {  // libpvm prints errors to stderr unless told not to
  int before = pvm_setopt(PvmAutoErr, 0);
  ~Silence() { pvm_setopt(PvmAutoErr, before); }
};

std::vector<std::string> hostNames() {
  int hosts = 0, architectures = 0;
  pvmhostinfo* list = nullptr;
  if (pvm_config(&hosts, &architectures, &list) < 0)
    throw MachineError("the virtual machine does not answer: run `echo halt | pvm` and try again");
  std::vector<std::string> names;
  for (int i = 0; i < hosts; ++i) names.push_back(list[i].hi_name);
  return names;
}

// What a host file asks for, and the name by which the daemon is to know this machine; "": what it thinks itself.
struct WantedHosts {
  std::vector<HostLine> hosts;
  std::string ownName;
};

WantedHosts readWantedHosts(const std::string& hostFile) {
  if (hostFile.empty())
    return {{}, "localhost"};  // binds the daemon to 127.0.0.1, out of reach of the network
  std::ifstream in(hostFile);
  if (!in) throw MachineError(hostFile + ": the host file cannot be read");
  WantedHosts wanted{readHostFile(in, hostFile), ""};
  const auto own = std::find_if(wanted.hosts.begin(), wanted.hosts.end(),
                                [](const HostLine& h) { return isThisMachine(h.name); });
  if (own != wanted.hosts.end()) {
    wanted.ownName = own->name;
  } else if (wanted.hosts.empty()) {
    wanted.ownName = "localhost";
  }
  return wanted;
}

void prepareEnvironment() {
  if (environment("PVMSOCK").empty()) unsetenv("PVMSOCK");  // libpvm takes an empty one for an address
  if (geteuid() == 0) setenv("PVM_ALLOW_ROOT", "1", 0);  // differs from PVM, which wants root to ask for it
  if (environment("PVM_ROOT").empty() && std::filesystem::is_directory("/usr/lib/pvm3"))
    setenv("PVM_ROOT", "/usr/lib/pvm3", 1);
}

// A place for PVM's files where the usual one is no use.
std::string makePrivateDirectory() {
  if (!environment("PVM_TMP").empty())
    throw MachineError("PVM_TMP=" + pvmDirectory() + " cannot be used (not writable, or " + pvmFile("pvmd") +
                       " is another user's): name a directory of your own or unset PVM_TMP");
  std::string base = environment("XDG_RUNTIME_DIR");
  if (!usableDirectory(base)) base = std::filesystem::temp_directory_path().string();
  std::string directory = base + "/rayshade-pvm-XXXXXX";
  if (!mkdtemp(directory.data()))
    throw MachineError("no place for PVM's files: " + directory + ": " + std::strerror(errno) +
                       "; set PVM_TMP");
  return directory;
}

}  // namespace

bool isThisMachine(const std::string& name) {
  char own[256] = {};
  gethostname(own, sizeof own - 1);
  if (name == own) return true;
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_INET;  // PVM knows no other
  hints.ai_socktype = SOCK_STREAM;
  if (getaddrinfo(name.c_str(), nullptr, &hints, &found) != 0) return false;
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> keepFound(found, freeaddrinfo);
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return false;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> keepInterfaces(interfaces, freeifaddrs);
  const auto address = [](const sockaddr* a) {
    return reinterpret_cast<const sockaddr_in*>(a)->sin_addr.s_addr;
  };
  for (const ifaddrs* i = interfaces; i; i = i->ifa_next) {
    if (i->ifa_addr && i->ifa_addr->sa_family == AF_INET && address(i->ifa_addr) == address(found->ai_addr))
      return true;
  }
  return false;
}

VirtualMachine::VirtualMachine(const MachineOptions& options) {
  const WantedHosts wanted = readWantedHosts(options.hostFile);
  prepareEnvironment();
  MachineState state = lookForMachine();
  if (!environment("PVMSOCK").empty() && state != MachineState::alive)
    throw MachineError("PVMSOCK is set, but no daemon answers at " + environment("PVMSOCK") +
                       ": unset PVMSOCK");
  const bool usable = state != MachineState::foreign && usableDirectory(pvmDirectory());
  if (state != MachineState::alive && !usable) {
    privateDirectory_ = makePrivateDirectory();
    setenv("PVM_TMP", privateDirectory_.c_str(), 1);
    state = MachineState::none;
  }
  try {
    if (state != MachineState::alive) startDaemon(options.hostFile, wanted.ownName, daemon_);
    const Silence silence;
    if (pvm_mytid() < 0)
      throw MachineError("the daemon at " + socketPath() +
                         " does not let this process join: run `echo halt | pvm`");
    joinHosts(wanted.hosts, options);
  } catch (...) {
    halt();
    throw;
  }
}

VirtualMachine::~VirtualMachine() { halt(); }

void VirtualMachine::joinHosts(const std::vector<HostLine>& wanted, const MachineOptions& options) {
  const double end = steadySeconds() + kJoinSeconds;
  std::string problem;
  for (const HostLine& host : wanted) {
    // This process has joined from here, so this machine is in, whatever it is called in a machine that was running.
    if (isThisMachine(host.name)) continue;
    int code = PvmAlready;
    for (;;) {
      checkInterruption();
      const std::vector<std::string> present = hostNames();
      if (std::find(present.begin(), present.end(), host.name) != present.end()) code = PvmOk;
      if (code != PvmAlready || steadySeconds() > end) break;
      // A daemon that is still busy with its host file answers PvmAlready; else this is the first or second
      // try.
      std::string line = host.name + (host.options.empty() ? "" : " " + host.options);
      char* lines[] = {line.data()};
      if (const int result = pvm_addhosts(lines, 1, &code); result < 0) code = result;
      if (code == PvmDupHost || code > 0) code = PvmOk;  // there, under another name
      if (code == PvmAlready) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    if (code == PvmOk) continue;
    missing_.push_back(host.name);
    problem += (problem.empty() ? "" : "; ") + ("host " + host.name + ": " + whyHostFailed(host.name, code));
  }
  if (!missing_.empty() && !options.allowMissingHosts)
    throw MachineError(options.hostFile + ": " + problem + "; or take it out of the host file");
}

void VirtualMachine::halt() {
  if (daemon_ > 0) {
    const Silence silence;
    const bool alive = lookForMachine() == MachineState::alive;
    if (alive) pvm_exit();
    endDaemon(std::exchange(daemon_, 0));
    removeLeftovers();
    if (!alive)
      pvm_exit();  // libpvm forgets the dead daemon - at once now that no file leads to it, else after 4 s
    removeRouteSockets(kFarewellSeconds);
  }
  if (!privateDirectory_.empty()) {
    std::error_code ignored;
    std::filesystem::remove_all(privateDirectory_, ignored);
    if (environment("PVM_TMP") == privateDirectory_) unsetenv("PVM_TMP");
    privateDirectory_.clear();
  }
}

}  // namespace rayshade
