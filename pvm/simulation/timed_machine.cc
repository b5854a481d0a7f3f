// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/timed_machine.h"

#include <algorithm>
#include <stdexcept>

#include "pvm/simulation/simulated_task.h"

namespace rayshade {
namespace {

constexpr Nanoseconds kLeastTurn = 100;  // looking at the link, at least

}  // namespace

class TimedMachine::Inside final : public Link {
 public:
  Inside(TimedMachine& machine, TaskId self) : machine_(machine), self_(self) {}

  TaskId self() const override { return self_; }
  TaskId parent() const override { return kHost; }
  void send(TaskId to, std::span<const std::byte> packet) override {
    machine_.sendFrom(self_, to, {LinkEvent::Kind::packet, self_, "", Bytes(packet.begin(), packet.end())},
                      time());
  }
  std::optional<LinkEvent> poll() override {
    if (arrived.empty()) return std::nullopt;
    LinkEvent event = std::move(arrived.front());
    arrived.pop_front();
    return event;
  }
  std::optional<LinkEvent> wait(double) override { return std::nullopt; }  // turns do not wait
  void watch(TaskId task) override { machine_.watchers_[task].insert(self_); }
  double now() const override { return toSeconds(time()); }
  Usage usage() const override { return {toSeconds(busy + time() - since), task->heldBytes()}; }
  unsigned cores() const override { return machine_.spec_.cores; }
  void useThreads(unsigned threads) override {
    freeWorkers.clear();
    for (unsigned i = threads; i-- > 0;) freeWorkers.push_back(i);
    jobs.clear();
    ++generation;
  }
  void run(Job job) override {
    jobs.push_back(std::move(job));
    machine_.schedule(Happening::Kind::jobGiven, time(), self_, 0);
  }

  // An activity begins now, and has taken so long when it ends.
  void begin() {
    since = machine_.time_;
    costSince = task ? machine_.cost(task->counted()) : 0;
  }
  Nanoseconds end() {
    const Nanoseconds span = std::max(time() - since, kLeastTurn);
    busy += span;
    since = machine_.time_;
    costSince = machine_.cost(task->counted());
    return span;
  }
  Nanoseconds time() const { return since + (task ? machine_.cost(task->counted()) - costSince : 0); }

  std::unique_ptr<SimulatedTask> task;
  std::deque<LinkEvent> arrived;
  Nanoseconds busy = 0, since = 0, costSince = 0;
  std::deque<Job> jobs;
  std::vector<unsigned> freeWorkers;
  std::uint32_t generation = 0;  // of workers

 private:
  TimedMachine& machine_;
  TaskId self_;
};

struct TimedMachine::Running {
  Running(TimedMachine& machine, TaskId self, std::uint32_t hostNumber)
      : id(self), host(hostNumber), link(machine, self) {}
  TaskId id;
  std::uint32_t host;
  Inside link;
  enum class State : std::uint8_t { asleep, ready, acting } state = State::asleep;
  Nanoseconds asleepSince = 0;
  std::uint64_t sleeps = 0;
  double patience = 0;  // after the turn
};

TimedMachine::TimedMachine(const MachineSpec& spec, const UnitCosts& costs, std::uint32_t processors)
    : spec_(spec), costs_(costs), network_(spec.network, spec.hosts) {
  if (processors > spec.hosts * spec.cores)
    throw std::runtime_error("the machine has only " + std::to_string(spec.hosts * spec.cores) +
                             " processors");
  for (std::uint32_t left = processors; left > 0;) {
    const std::uint32_t cores = std::min(left, spec.cores);
    std::string name = std::to_string(hosts_.size() + 1);
    name.insert(0, name.size() < 4 ? 4 - name.size() : 0, '0');
    hosts_.push_back({"host" + name, cores, {}});
    left -= cores;
  }
  --hosts_[0].freeCores;  // the host task acts
}
TimedMachine::~TimedMachine() = default;

std::vector<HostInfo> TimedMachine::hosts() {
  std::vector<HostInfo> all;
  for (const Host& host : hosts_) all.push_back({host.name});
  return all;
}

Nanoseconds TimedMachine::cost(const Report& counted) const {
  const double packets = static_cast<double>(counted.packetsIn + counted.packetsOut);
  return static_cast<Nanoseconds>(costs_.of(counted) / spec_.speed + 1e9 * spec_.network.overhead * packets);
}

void TimedMachine::schedule(Happening::Kind kind, Nanoseconds at, TaskId task, std::uint64_t number,
                            std::uint32_t host) {
  happenings_.push({kind, at, order_++, task, number, host});
}

void TimedMachine::handle(const Happening& what) {
  const auto found = tasks_.find(what.task);
  Running* const running = found == tasks_.end() ? nullptr : found->second.get();
  switch (what.kind) {
    case Happening::Kind::wake:
      if (running != nullptr && running->state == Running::State::asleep && running->sleeps == what.number)
        wakeUp(*running);
      break;
    case Happening::Kind::endOfTurn:
      endTurn(what.task, what.host);
      break;
    case Happening::Kind::jobGiven:
      if (running != nullptr) offerJobs(*running);
      break;
    case Happening::Kind::endOfJob:
      endJob(what.task, what.number, what.host);
      break;
    case Happening::Kind::onTheWay:
      travel(what.number);
      break;
    case Happening::Kind::arrival:
      arrive(what.number);
      break;
  }
}

void TimedMachine::advanceTo(Nanoseconds time) {
  while (!happenings_.empty() && happenings_.top().at <= time) {
    const Happening next = happenings_.top();
    happenings_.pop();
    time_ = next.at;
    handle(next);
  }
  time_ = time;
}

// ---- packets

std::uint32_t TimedMachine::hostOf(TaskId task) const {
  const auto found = tasks_.find(task);
  return found == tasks_.end() ? 0 : found->second->host;
}

void TimedMachine::sendFrom(TaskId from, TaskId to, LinkEvent event, Nanoseconds at) {
  if (to != kHost && !tasks_.contains(to)) return;
  std::uint64_t number = packets_.size();
  if (freePackets_.empty()) {
    packets_.emplace_back();
  } else {
    number = freePackets_.back();
    freePackets_.pop_back();
  }
  Packet& packet = packets_[number];
  packet.to = to;
  packet.event = std::move(event);
  packet.journey = {hostOf(from), hostOf(to), hostOf(from), 0, packet.event.bytes.size()};
  schedule(Happening::Kind::onTheWay, at, to, number);
}

void TimedMachine::travel(std::uint64_t number) {
  const Network::Passed passed = network_.pass(packets_[number].journey, time_);
  schedule(passed.arrived ? Happening::Kind::arrival : Happening::Kind::onTheWay, passed.at,
           packets_[number].to, number);
}

void TimedMachine::arrive(std::uint64_t number) {
  Packet& packet = packets_[number];
  LinkEvent event = std::move(packet.event);
  const TaskId to = packet.to;
  packet.event = {};
  freePackets_.push_back(number);
  if (to == kHost) {
    forHost_.push_back(std::move(event));
    return;
  }
  const auto found = tasks_.find(to);
  if (found == tasks_.end()) return;
  found->second->link.arrived.push_back(std::move(event));
  if (found->second->state == Running::State::asleep) wakeUp(*found->second);
}

// ---- processors

void TimedMachine::wakeUp(Running& running) {
  ++running.sleeps;
  running.link.begin();
  running.link.task->noteIdle(toSeconds(time_ - running.asleepSince));
  running.state = Running::State::ready;
  hosts_[running.host].ready.push_back({running.id, false});
  startReady(running.host);
}

void TimedMachine::startReady(std::uint32_t number) {
  Host& host = hosts_[number];
  while (host.freeCores > 0 && !host.ready.empty()) {
    const Activity next = host.ready.front();
    host.ready.pop_front();
    if (next.task == kHost) {
      --host.freeCores;
      hostActs_ = true;
      continue;
    }
    const auto found = tasks_.find(next.task);
    if (found == tasks_.end()) continue;
    --host.freeCores;
    if (next.job) {
      startJob(*found->second);
    } else {
      startTurn(*found->second);
    }
  }
}

void TimedMachine::startTurn(Running& running) {
  running.state = Running::State::acting;
  running.link.begin();
  running.patience = running.link.task->turn();
  if (running.link.task->finished()) running.link.task->flush();
  schedule(Happening::Kind::endOfTurn, time_ + running.link.end(), running.id, 0, running.host);
}

void TimedMachine::endTurn(TaskId task, std::uint32_t host) {
  ++hosts_[host].freeCores;
  if (const auto found = tasks_.find(task); found != tasks_.end()) {
    Running& running = *found->second;
    if (running.link.task->finished()) {
      bury(task, time_);
    } else if (running.patience > 0 && running.link.arrived.empty()) {
      running.state = Running::State::asleep;
      running.asleepSince = time_;
      schedule(Happening::Kind::wake, time_ + toNanoseconds(running.patience), task, running.sleeps);
    } else {
      running.state = Running::State::ready;
      hosts_[host].ready.push_back({task, false});
    }
  }
  startReady(host);
}

// ---- jobs of threads

void TimedMachine::offerJobs(Running& running) {
  for (std::size_t i = 0; i < std::min(running.link.jobs.size(), running.link.freeWorkers.size()); ++i)
    hosts_[running.host].ready.push_back({running.id, true});
  startReady(running.host);
}

void TimedMachine::startJob(Running& running) {
  Inside& link = running.link;
  if (link.jobs.empty() || link.freeWorkers.empty()) {  // offered once too often
    ++hosts_[running.host].freeCores;
    return;
  }
  const unsigned worker = link.freeWorkers.back();
  link.freeWorkers.pop_back();
  const Link::Job job = std::move(link.jobs.front());
  link.jobs.pop_front();
  link.begin();
  job(worker);
  const std::uint64_t number = std::uint64_t{link.generation} << 32 | worker;
  schedule(Happening::Kind::endOfJob, time_ + link.end(), running.id, number, running.host);
}

void TimedMachine::endJob(TaskId task, std::uint64_t worker, std::uint32_t host) {
  ++hosts_[host].freeCores;
  const auto found = tasks_.find(task);
  if (found != tasks_.end() && found->second->link.generation == worker >> 32) {
    Running& running = *found->second;
    running.link.freeWorkers.push_back(static_cast<unsigned>(worker));
    running.link.arrived.push_back({LinkEvent::Kind::jobDone, task, "", {}});
    if (running.state == Running::State::asleep) wakeUp(running);
    offerJobs(running);
  }
  startReady(host);
}

// ---- life and death

Spawned TimedMachine::spawn(Role role, const std::string& name) {
  const auto host = std::find_if(hosts_.begin(), hosts_.end(), [&](const Host& h) { return h.name == name; });
  if (host == hosts_.end()) return {kNobody, "there is no host " + name};
  const TaskId id{nextTask_++};
  auto running = std::make_unique<Running>(*this, id, static_cast<std::uint32_t>(host - hosts_.begin()));
  running->link.since = running->asleepSince = hostNow();
  running->link.task = makeTask(role, running->link);
  if (!running->link.task) return {kNobody, std::string("no such program: ") + programName(role)};
  schedule(Happening::Kind::wake, hostNow(), id, running->sleeps);
  tasks_[id] = std::move(running);
  return {id, ""};
}

// The notice comes after the last words.
void TimedMachine::bury(TaskId task, Nanoseconds now) {
  if (!tasks_.contains(task)) return;
  for (const TaskId watcher : watchers_[task])
    sendFrom(task, watcher, {LinkEvent::Kind::taskExit, task, "", {}}, now);
  watchers_.erase(task);
  tasks_.erase(task);
}

// ---- the host task

Nanoseconds TimedMachine::hostNow() const {
  return hostSince_ + (hostCounted_ ? cost(hostCounted_()) - hostCostSince_ : 0);
}

void TimedMachine::hostGoesOn() {
  hostSince_ = time_;
  hostCostSince_ = hostCounted_ ? cost(hostCounted_()) : 0;
}

Usage TimedMachine::usage() const { return {toSeconds(hostBusy_ + hostNow() - hostSince_), 0}; }

void TimedMachine::send(TaskId to, std::span<const std::byte> packet) {
  sendFrom(kHost, to, {LinkEvent::Kind::packet, kHost, "", Bytes(packet.begin(), packet.end())}, hostNow());
}

std::optional<LinkEvent> TimedMachine::takeForHost() {
  if (forHost_.empty()) return std::nullopt;
  LinkEvent event = std::move(forHost_.front());
  forHost_.pop_front();
  return event;
}

// Others went on while the host acted.
std::optional<LinkEvent> TimedMachine::poll() {
  const Nanoseconds now = hostNow();
  hostBusy_ += now - hostSince_;
  advanceTo(now);
  hostGoesOn();
  return takeForHost();
}

std::optional<LinkEvent> TimedMachine::wait(double seconds) {
  if (std::optional<LinkEvent> event = poll()) return event;
  const Nanoseconds deadline = time_ + toNanoseconds(seconds);
  hostActs_ = false;
  ++hosts_[0].freeCores;
  startReady(0);
  while (forHost_.empty() && !happenings_.empty() && happenings_.top().at <= deadline)
    advanceTo(happenings_.top().at);
  if (forHost_.empty()) advanceTo(deadline);
  hosts_[0].ready.push_back({kHost, false});
  startReady(0);
  while (!hostActs_) advanceTo(happenings_.top().at);
  hostGoesOn();
  return takeForHost();
}

}  // namespace rayshade
