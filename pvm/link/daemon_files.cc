// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/link/daemon_files.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

namespace rayshade {
namespace {

bool mine(const std::string& path, mode_t kind) {
  struct stat status {};
  return lstat(path.c_str(), &status) == 0 && status.st_uid == geteuid() && (status.st_mode & S_IFMT) == kind;
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

// True: some are left whose processes live.
bool removeSocketsOfTheDead() {
  const std::string prefix = "pvmtmp";  // pvmtmp<process number>.<count>
  bool someLive = false;
  std::error_code ignored;
  std::filesystem::directory_iterator entry(pvmDirectory(), ignored);
  for (; entry != std::filesystem::directory_iterator(); entry.increment(ignored)) {
    const std::string path = entry->path().string(), name = entry->path().filename().string();
    const bool isSocket = mine(path, S_IFSOCK);
    // A file: by writing into it a task shows whose it is.  One that the daemon refuses may leave it.
    if (!name.starts_with(prefix) || (!isSocket && !mine(path, S_IFREG))) continue;
    const long process = std::strtol(name.c_str() + prefix.size(), nullptr, 10);
    std::ifstream commandLine("/proc/" + std::to_string(process) + "/cmdline");
    const bool lives = commandLine.peek() != std::ifstream::traits_type::eof();
    someLive = someLive || (lives && process != getpid());
    if (process <= 0 || (lives && process != getpid())) continue;
    // Our own are still open when the daemon has gone and libpvm could not end in order.  The daemon of an added host
    // listens at a socket with the number of its parent, which has ended.
    if (process == getpid() || !isSocket || knock(path) == MachineState::stale) unlink(path.c_str());
  }
  return someLive;
}

}  // namespace

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string pvmDirectory() {
  const std::string directory = environment("PVM_TMP");
  return directory.empty() ? "/tmp" : directory;
}

std::string pvmFile(const char* kind) {
  std::string file = pvmDirectory() + "/" + kind + "." + std::to_string(getuid());
  if (const char* id = std::getenv("PVM_VMID"))
    file += std::string(".") + id;  // set but empty gives a "." too
  return file;
}

std::string socketPath() {
  if (const std::string given = environment("PVMSOCK"); !given.empty()) return given;
  std::string path;
  std::ifstream in(pvmFile("pvmd"));
  std::getline(in, path);
  return path;
}

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

MachineState lookForMachine() {
  if (!environment("PVMSOCK").empty()) return knock(environment("PVMSOCK"));
  const std::string file = pvmFile("pvmd");
  struct stat status {};
  if (lstat(file.c_str(), &status) != 0) return MachineState::none;
  if (status.st_uid != geteuid() || !S_ISREG(status.st_mode)) return MachineState::foreign;
  if (status.st_size == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // a daemon may be about to write it
  return knock(socketPath());
}

void removeRouteSockets(double patience) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  while (removeSocketsOfTheDead() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

}  // namespace rayshade
