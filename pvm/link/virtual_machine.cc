// See virtual_machine.h.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/virtual_machine.h"

#include <fcntl.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <pvm3.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>
#include <utility>

namespace rayshade {
namespace {

using std::chrono::milliseconds;

constexpr double kStartSeconds = 15;  // for the daemon to say that it is ready
constexpr double kJoinSeconds = 120;  // for all hosts; PVM itself gives up on one after 60
constexpr double kHaltSeconds = 5;    // for the daemon to end its tasks and itself
constexpr rlim_t kDescriptors =
    1024;  // the daemon uses select(): it breaks above, and closes each of them one by one

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string pvmDirectory() {
  const std::string directory = environment("PVM_TMP");
  return directory.empty() ? "/tmp" : directory;
}

// PVM's files: pvmd = where the daemon's socket is, pvml = its log.
std::string pvmFile(const char* kind) {
  std::string file = pvmDirectory() + "/" + kind + "." + std::to_string(getuid());
  if (const char* id = std::getenv("PVM_VMID"))
    file += std::string(".") + id;  // set but empty gives a "." too
  return file;
}

bool mine(const std::string& path, mode_t kind) {
  struct stat status {};
  return lstat(path.c_str(), &status) == 0 && status.st_uid == geteuid() && (status.st_mode & S_IFMT) == kind;
}

std::string socketPath() {
  if (const std::string given = environment("PVMSOCK"); !given.empty()) return given;
  std::string path;
  std::ifstream in(pvmFile("pvmd"));
  std::getline(in, path);
  return path;
}

MachineState knock(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path[0] != '/' || path.size() >= sizeof address.sun_path) return MachineState::stale;
  std::memcpy(address.sun_path, path.data(), path.size());
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return MachineState::foreign;  // nobody knows: then it is not ours to remove
  const bool answered =
      connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ||
      errno == EAGAIN;
  const bool forbidden = !answered && (errno == EACCES || errno == EPERM);
  close(descriptor);
  return answered ? MachineState::alive : forbidden ? MachineState::foreign : MachineState::stale;
}

// Only what is ours and is what it should be: the address file is not to be trusted with names of other
// files.
void removeLeftovers() {
  const std::string socket = socketPath();
  if (!socket.empty() && mine(socket, S_IFSOCK)) unlink(socket.c_str());
  for (const char* kind : {"pvmd", "pvml"}) {
    // an old log makes a new daemon log nothing at all
    if (const std::string file = pvmFile(kind); mine(file, S_IFREG)) unlink(file.c_str());
  }
}

bool usableDirectory(const std::string& directory) {
  struct stat status {};
  return stat(directory.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         access(directory.c_str(), W_OK | X_OK) == 0;
}

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
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur > kDescriptors) {
    limit.rlim_cur = kDescriptors;
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execv(program, arguments);
  _exit(127);
}

// What the daemon printed until it was ready, ended, or the time was over; ready = a line that begins with
// '/'.
std::string readUntilReady(int descriptor, bool& ready) {
  const double end = seconds() + kStartSeconds;
  std::string text;
  for (ready = false; !ready && seconds() < end;) {
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

MachineState lookForMachine() {
  if (!environment("PVMSOCK").empty()) return knock(environment("PVMSOCK"));
  const std::string file = pvmFile("pvmd");
  struct stat status {};
  if (lstat(file.c_str(), &status) != 0) return MachineState::none;
  if (status.st_uid != geteuid() || !S_ISREG(status.st_mode)) return MachineState::foreign;
  if (status.st_size == 0)
    std::this_thread::sleep_for(milliseconds(100));  // a daemon may be about to write it
  return knock(socketPath());
}

std::string daemonProgram() {
  std::istringstream path(environment("PATH") + ":" + environment("PVM_ROOT") +
                          "/lib:/usr/bin:/usr/lib/pvm3/lib");
  for (std::string directory; std::getline(path, directory, ':');) {
    const std::string program = directory + "/pvmd";
    if (directory.starts_with('/') && access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

void removeRouteSockets() {
  const std::string prefix = "pvmtmp";  // pvmtmp<process number>.<count>
  std::error_code ignored;
  std::filesystem::directory_iterator entry(pvmDirectory(), ignored);
  for (; entry != std::filesystem::directory_iterator(); entry.increment(ignored)) {
    const std::string path = entry->path().string(), name = entry->path().filename().string();
    if (!name.starts_with(prefix) || !mine(path, S_IFSOCK)) continue;
    const long process = std::strtol(name.c_str() + prefix.size(), nullptr, 10);
    std::ifstream commandLine("/proc/" + std::to_string(process) + "/cmdline");
    const bool ended = commandLine.peek() == std::ifstream::traits_type::eof();
    if (process <= 0 || (!ended && process != getpid())) continue;
    // The daemon of an added host listens at a socket with the number of its parent, which has ended.
    if (knock(path) == MachineState::stale) unlink(path.c_str());
  }
}

VirtualMachine::VirtualMachine(const MachineOptions& options) {
  std::vector<HostLine> wanted;
  std::string ownName = "localhost";  // binds the daemon to 127.0.0.1, out of reach of the network
  if (!options.hostFile.empty()) {
    std::ifstream in(options.hostFile);
    if (!in) throw MachineError(options.hostFile + ": the host file cannot be read");
    wanted = readHostFile(in);
    const auto own =
        std::find_if(wanted.begin(), wanted.end(), [](const HostLine& h) { return isThisMachine(h.name); });
    if (own != wanted.end()) {
      ownName = own->name;
    } else if (!wanted.empty()) {
      ownName = "";  // what the daemon thinks itself
    }
  }

  if (environment("PVMSOCK").empty()) unsetenv("PVMSOCK");  // libpvm takes an empty one for an address
  if (geteuid() == 0) setenv("PVM_ALLOW_ROOT", "1", 0);  // differs from PVM, which wants root to ask for it
  if (environment("PVM_ROOT").empty() && std::filesystem::is_directory("/usr/lib/pvm3")) {
    setenv("PVM_ROOT", "/usr/lib/pvm3", 1);
  }

  MachineState state = lookForMachine();
  if (!environment("PVMSOCK").empty() && state != MachineState::alive)
    throw MachineError("PVMSOCK is set, but no daemon answers at " + environment("PVMSOCK") +
                       ": unset PVMSOCK");
  const bool usable = state != MachineState::foreign && usableDirectory(pvmDirectory());
  if (state != MachineState::alive && !usable) {
    if (!environment("PVM_TMP").empty())
      throw MachineError("PVM_TMP=" + pvmDirectory() + " cannot be used (not writable, or " +
                         pvmFile("pvmd") +
                         " is another user's): name a directory of your own or unset PVM_TMP");
    std::string base = environment("XDG_RUNTIME_DIR");
    if (!usableDirectory(base)) base = std::filesystem::temp_directory_path().string();
    privateDirectory_ = base + "/rayshade-pvm-XXXXXX";
    if (!mkdtemp(privateDirectory_.data())) {
      const std::string tried = std::exchange(privateDirectory_, "");
      throw MachineError("no place for PVM's files: " + tried + ": " + std::strerror(errno) +
                         "; set PVM_TMP");
    }
    setenv("PVM_TMP", privateDirectory_.c_str(), 1);
    state = MachineState::none;
  }

  try {
    if (state != MachineState::alive) start(options.hostFile, ownName);
    const Silence silence;
    if (pvm_mytid() < 0)
      throw MachineError("the daemon at " + socketPath() +
                         " does not let this process join: run `echo halt | pvm`");
    joinHosts(wanted, options);
  } catch (...) {
    halt();
    throw;
  }
}

VirtualMachine::~VirtualMachine() { halt(); }

void VirtualMachine::start(const std::string& hostFile, const std::string& ownName) {
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
  daemon_ = std::max(child, 0);
  if (!ready) throw MachineError(program + " did not start: " + inOneLine(printed));
  if (lookForMachine() !=
      MachineState::alive)  // two were started at once, and the other has the address file
    throw MachineError("a second pvmd was started at the same moment: try again");
}

void VirtualMachine::joinHosts(const std::vector<HostLine>& wanted, const MachineOptions& options) {
  const double end = seconds() + kJoinSeconds;
  std::string problem;
  for (const HostLine& host : wanted) {
    // This process has joined from here, so this machine is in, whatever it is called in a machine that was running.
    if (isThisMachine(host.name)) continue;
    int code = PvmAlready;
    for (;;) {
      const std::vector<std::string> present = hostNames();
      if (std::find(present.begin(), present.end(), host.name) != present.end()) code = PvmOk;
      if (code != PvmAlready || seconds() > end) break;
      // A daemon that is still busy with its host file answers PvmAlready; else this is the first or second
      // try.
      std::string line = host.name + (host.options.empty() ? "" : " " + host.options);
      char* lines[] = {line.data()};
      if (const int result = pvm_addhosts(lines, 1, &code); result < 0) code = result;
      if (code == PvmDupHost || code > 0) code = PvmOk;  // there, under another name
      if (code == PvmAlready) std::this_thread::sleep_for(milliseconds(50));
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
    // The daemon ends all tasks with SIGTERM, and may not have read yet that this one has left.
    struct sigaction before {};
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGTERM, &ignore, &before);
    kill(daemon_, SIGTERM);
    const double end = seconds() + kHaltSeconds;
    while (waitpid(daemon_, nullptr, WNOHANG) == 0) {
      if (seconds() > end) kill(daemon_, SIGKILL);
      std::this_thread::sleep_for(milliseconds(5));
    }
    daemon_ = 0;
    sigaction(SIGTERM, &before, nullptr);
    removeLeftovers();
    if (!alive)
      pvm_exit();  // libpvm forgets the dead daemon - at once now that no file leads to it, else after 4 s
    removeRouteSockets();
  }
  if (!privateDirectory_.empty()) {
    std::error_code ignored;
    std::filesystem::remove_all(privateDirectory_, ignored);
    if (environment("PVM_TMP") == privateDirectory_) unsetenv("PVM_TMP");
    privateDirectory_.clear();
  }
}

}  // namespace rayshade
