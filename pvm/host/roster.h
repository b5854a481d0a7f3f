// Who lives: the slave tasks, where each one stands, and who succeeds the dead (Reinhard & Jansen, figure 2: the host
// "initialises a number of slave processes").
//
// A slave is a place of the process mapping and the task that fills it.  When the task dies the place stays empty until
// a successor is started; until then the roster is not complete.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>

#include "pvm/host/summary.h"
#include "pvm/messages/outbox.h"
#include "pvm/schedule/options.h"

namespace rayshade {

struct Slave {
  Placement placement;
  TaskId task = kNobody;  // kNobody: dead, or not started yet
  bool hasItems = false;
  int earlyDeaths = 0;    // in a row, before it was ready
  int batchesOut = 0;     // shipped and not answered
  bool ready = false;     // for the epoch
  double heard = 0;       // when it last said anything
  bool pinged = false;    // since then
  double busy = 0;        // share of its time, as it said last
  bool reported = false;  // its last words
  bool observed = false;  // the events that it noted
  double observedFrom = 0;
  TaskSummary summary;
};

// Who is who; all shade tasks weigh the same.
void enlist(const std::vector<Slave>& slaves, Directory& directory);

// Dynamic placement of shading: the less a shade task's machine has to do, the more intersections it gets.
std::vector<std::uint32_t> weighShadeTasks(const std::vector<Slave>& slaves);

class Roster {
 public:
  // The places; nobody is started.  Throws HostError when there are no hosts.
  Roster(Machine& machine, const HostOptions& options);

  std::vector<Slave>& slaves() { return slaves_; }  // never fewer, never more
  std::vector<Slave*> slavesOf(Role role);
  Slave* find(TaskId task);  // null: it is dead, or no slave

  std::function<void(TaskId)> onDeath;  // may be empty

  bool complete() const { return byTask_.size() == slaves_.size(); }
  bool deserted() const { return byTask_.empty(); }
  int successions() const { return successions_; }

  // Starts a task for every place that has none, first where the mapping puts it, then wherever there is a host.  Throws
  // HostError when none can be started or too many have died.  Says which tasks have begun.
  std::vector<TaskId> startMissing();
  void bury(Slave& slave, const std::string& how);
  void buryHost(const std::string& host);  // all that stood there
  // Pings who is silent; kills and buries who does not answer either, after so many seconds.
  void lookAfterSilent(Outbox& outbox, double killAfter);

 private:
  void checkSuccession(const Slave& slave);
  Spawned spawn(Slave& slave, const std::vector<HostInfo>& hosts);

  Machine& machine_;
  const HostOptions& options_;
  Wishes wishes_;  // as they were for the first hosts: the same places, whatever hosts come and go
  std::vector<Slave> slaves_;
  std::map<std::int32_t, std::size_t> byTask_;  // of the living
  int successions_ = 0;
  std::string lastDeath_;  // who, where and how
};

}  // namespace rayshade
