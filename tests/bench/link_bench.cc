// How many records per packet pay: requests and answers of 128-byte records between two tasks, some packets in flight.
//
//   link_bench [host]      host: where the second task runs; default this machine; needs a virtual machine there
//
// Prints for each size of packets: records per second, and the CPU time of both tasks per record in microseconds
// (without that of the daemons), and the round trip of one record; by direct route, as all tasks that exchange more than a
// few packets.
// SPDX-License-Identifier: BSD-3-Clause
#include <sys/resource.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "pvm/link/pvm_link.h"
#include "pvm/link/virtual_machine.h"

namespace rayshade {
namespace {

constexpr std::size_t kRecordBytes = 128;
constexpr int kInFlight = 4;    // packets
constexpr double kSeconds = 1;  // for one measurement
constexpr double kPatience = 20;

double cpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Sends back what comes; an empty packet is answered with the CPU time used up to now.
int answer() {
  PvmLink link;
  link.watch(link.parent());
  while (const auto event = link.wait(kPatience)) {
    if (event->kind != LinkEvent::Kind::packet) return 0;
    link.send(event->task, event->bytes.empty() ? encode(cpuSeconds()) : event->bytes);
  }
  return 1;
}

Bytes next(PvmLink& link) {
  while (auto event = link.wait(kPatience)) {
    if (event->kind == LinkEvent::Kind::packet) return std::move(event->bytes);
  }
  throw LinkLost("the second task does not answer");
}

double peerCpu(PvmLink& link, TaskId peer) {
  link.send(peer, {});
  return decode<double>(next(link)).value_or(0);
}

void measure(PvmLink& link, TaskId peer, int records, int inFlight) {
  const Bytes packet(static_cast<std::size_t>(records) * kRecordBytes);
  const double cpuBefore = cpuSeconds() + peerCpu(link, peer);
  const double start = link.now();
  double turns = 0;
  for (int i = 0; i < inFlight; ++i) link.send(peer, packet);
  for (; link.now() - start < kSeconds; ++turns) {
    next(link);
    link.send(peer, packet);
  }
  for (int i = 0; i < inFlight; ++i, ++turns) next(link);
  const double seconds = link.now() - start;
  const double total = turns * records;
  const double cpu = cpuSeconds() + peerCpu(link, peer) - cpuBefore;
  std::printf("%8d %10d %14.0f %16.3f %14.1f\n", records, inFlight, total / seconds, cpu / total * 1e6,
              seconds / turns * inFlight * 1e6);
}

int run(const std::string& host) {
  const VirtualMachine machine{MachineOptions{}};
  PvmLink link([](Role) {
    return Command{std::filesystem::read_symlink("/proc/self/exe").string(), "--answer"};
  });
  const Spawned spawned = link.spawn(Role::shade, host);
  if (spawned.task == kNobody) throw LinkLost(spawned.problem);
  while (!link.connected(spawned.task)) peerCpu(link, spawned.task);
  std::printf(" records  in flight      records/s  CPU us per record  round trip us\n");
  measure(link, spawned.task, 1, 1);
  for (const int records : {1, 8, 64, 512}) measure(link, spawned.task, records, kInFlight);
  return 0;
}

}  // namespace
}  // namespace rayshade

int main(int count, char** words) {
  try {
    const std::string word = count > 1 ? words[1] : "";
    return word == "--answer" ? rayshade::answer() : rayshade::run(word);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "link_bench: %s\n", error.what());
    return 1;
  }
}
