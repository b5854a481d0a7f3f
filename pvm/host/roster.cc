// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/roster.h"

#include <algorithm>
#include <cmath>

namespace rayshade {

void enlist(const std::vector<Slave>& slaves, Directory& directory) {
  directory.voxelTasks.clear();
  directory.pyramidTasks.clear();
  directory.shadeTasks.clear();
  directory.machines.clear();
  std::map<std::string, std::uint32_t> machines;
  const auto enlistRole = [&](Role role, std::vector<TaskId>& tasks) {
    for (const Slave& slave : slaves) {
      if (slave.placement.role != role) continue;
      tasks.push_back(slave.task);
      if (role == Role::shade) continue;
      const auto next = static_cast<std::uint32_t>(machines.size());
      directory.machines.push_back(machines.try_emplace(slave.placement.host, next).first->second);
    }
  };
  enlistRole(Role::voxelTrace, directory.voxelTasks);
  enlistRole(Role::pyramidTrace, directory.pyramidTasks);
  enlistRole(Role::shade, directory.shadeTasks);
  directory.shadeWeights.assign(directory.shadeTasks.size(), 1);
}

std::vector<std::uint32_t> weighShadeTasks(const std::vector<Slave>& slaves) {
  std::map<std::string, double> busy;  // by machine
  for (const Slave& slave : slaves) busy[slave.placement.host] += slave.busy;
  std::vector<std::uint32_t> weights;
  for (const Slave& slave : slaves) {
    if (slave.placement.role != Role::shade) continue;
    const double load = busy[slave.placement.host] + 2 * slave.busy;
    weights.push_back(static_cast<std::uint32_t>(1000 / (0.1 + load)));
  }
  return weights;
}

Roster::Roster(Machine& machine, const HostOptions& options)
    : machine_(machine), options_(options), wishes_(options.wishes) {
  const std::vector<HostInfo> hosts = machine.hosts();
  if (hosts.empty()) throw HostError("the virtual machine has no hosts");
  wishes_.voxels = voxelTasksPerCluster(wishes_, hosts.size());
  for (const Placement& placement : mapProcesses(hosts, wishes_)) {
    Slave slave;
    slave.placement = placement;
    slaves_.push_back(slave);
  }
}

std::vector<Slave*> Roster::slavesOf(Role role) {
  std::vector<Slave*> slaves;
  for (Slave& slave : slaves_)
    if (slave.placement.role == role) slaves.push_back(&slave);
  return slaves;
}

Slave* Roster::find(TaskId task) {
  const auto found = byTask_.find(static_cast<std::int32_t>(task));
  return found == byTask_.end() ? nullptr : &slaves_[found->second];
}

std::vector<TaskId> Roster::startMissing() {
  std::vector<TaskId> begun;
  if (complete()) return begun;
  const std::vector<HostInfo> hosts = machine_.hosts();
  if (hosts.empty()) throw HostError("no host of the virtual machine is left");
  const std::vector<Placement> mapped = mapProcesses(hosts, wishes_);
  for (std::size_t i = 0; i < slaves_.size(); ++i) {
    Slave& slave = slaves_[i];
    if (slave.task != kNobody) continue;
    checkSuccession(slave);
    const bool stands = std::any_of(hosts.begin(), hosts.end(),
                                    [&](const HostInfo& h) { return h.name == slave.placement.host; });
    if (!stands) slave.placement = mapped[i];
    const Spawned spawned = spawn(slave, hosts);
    if (spawned.task == kNobody) throw HostError(spawned.problem);
    slave.task = spawned.task;
    slave.summary.task = spawned.task;
    slave.heard = machine_.now();
    slave.pinged = false;
    byTask_[static_cast<std::int32_t>(spawned.task)] = i;
    machine_.watch(spawned.task);
    begun.push_back(spawned.task);
  }
  return begun;
}

// Throws HostError when a place is not to be filled again.
void Roster::checkSuccession(const Slave& slave) {
  if (slave.summary.task != kNobody && ++successions_ > options_.mostSuccessions)
    throw HostError("tasks keep dying: given up after " + std::to_string(options_.mostSuccessions) +
                    " successors; the last to die was " + lastDeath_);
  if (slave.earlyDeaths >= options_.mostEarlyDeaths)
    throw HostError("given up after " + std::to_string(slave.earlyDeaths) + " deaths before it was ready: " +
                    lastDeath_ + "; with more tasks (--voxels) or hosts each holds less of the scene");
}

Spawned Roster::spawn(Slave& slave, const std::vector<HostInfo>& hosts) {
  Spawned spawned = machine_.spawn(slave.placement.role, slave.placement.host);
  const std::string problem = spawned.problem;  // where it should stand: worth telling
  for (std::size_t i = 0; spawned.task == kNobody && i < hosts.size(); ++i) {
    if (hosts[i].name == slave.placement.host) continue;
    spawned = machine_.spawn(slave.placement.role, hosts[i].name);
    if (spawned.task != kNobody) slave.placement.host = hosts[i].name;
  }
  return {spawned.task, problem};
}

void Roster::bury(Slave& slave, const std::string& how) {
  if (slave.task == kNobody) return;
  if (onDeath && !slave.reported) onDeath(slave.task);
  lastDeath_ = std::string(programName(slave.placement.role)) + " on " + slave.placement.host + ": " + how;
  slave.earlyDeaths = slave.ready ? 0 : slave.earlyDeaths + 1;
  byTask_.erase(static_cast<std::int32_t>(slave.task));
  slave.task = kNobody;
  slave.hasItems = false;
  slave.batchesOut = 0;
  slave.ready = false;
}

void Roster::buryHost(const std::string& host) {
  for (Slave& slave : slaves_)
    if (slave.placement.host == host) bury(slave, "its host left the virtual machine");
}

void Roster::lookAfterSilent(Outbox& outbox, double killAfter) {
  const double now = machine_.now();
  for (Slave& slave : slaves_) {
    if (slave.task == kNobody) continue;
    const double silence = now - slave.heard;
    if (silence > options_.pingAfter && !slave.pinged) {
      outbox.post(slave.task, Ping{});
      slave.pinged = true;
    }
    if (silence > killAfter && slave.pinged) {
      machine_.kill(slave.task);
      bury(slave, "no answer for " + std::to_string(std::lround(silence)) + " s");
    }
  }
}

}  // namespace rayshade
