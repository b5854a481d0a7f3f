// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/simulation/simulated_machine.h"

#include <algorithm>
#include <stdexcept>

#include "pvm/simulation/simulated_task.h"

namespace rayshade {
namespace {

constexpr double kMoveSeconds = 1e-5;

}  // namespace

std::size_t Channels::add(const Channel& channel, LinkEvent event) {
  Queue& queue = queues_[channel];
  queue.push_back(std::move(event));
  peak_ = std::max(peak_, ++size_);
  return queue.size();
}

LinkEvent Channels::take(const Channel& channel) {
  const auto at = queues_.find(channel);
  LinkEvent event = std::move(at->second.front());
  at->second.pop_front();
  --size_;
  if (at->second.empty()) queues_.erase(at);
  return event;
}

void Channels::cut(TaskId task, const std::function<std::size_t(std::size_t)>& keep) {
  for (auto it = queues_.begin(); it != queues_.end();) {
    auto& [channel, queue] = *it;
    std::size_t left = queue.size();
    if (channel.to == task) left = 0;
    if (channel.from == task && keep) left = keep(queue.size());
    size_ -= queue.size() - left;
    queue.resize(left);
    it = queue.empty() ? queues_.erase(it) : std::next(it);
  }
}

class SimulatedMachine::Inside final : public Link {
 public:
  Inside(SimulatedMachine& machine, TaskId self) : machine_(machine), self_(self) {}
  TaskId self() const override { return self_; }
  TaskId parent() const override { return kHost; }
  void send(TaskId to, std::span<const std::byte> packet) override { machine_.sendFrom(self_, to, packet); }
  std::optional<LinkEvent> poll() override { return std::nullopt; }  // the machine delivers by itself
  std::optional<LinkEvent> wait(double) override { return std::nullopt; }
  void watch(TaskId task) override { machine_.watchers_[task].insert(self_); }
  double now() const override { return machine_.time_ += 1e-7; }  // work takes time: it ends when asked to
  Usage usage() const override { return {}; }
  unsigned cores() const override { return machine_.options_.cores; }
  void useThreads(unsigned threads) override {
    threads_ = threads;
    jobs.clear();
  }
  void run(Job job) override { jobs.push_back(std::move(job)); }

  // Does one of the jobs that wait, by chance.
  void doOne() {
    const auto chosen = jobs.begin() + static_cast<std::ptrdiff_t>(machine_.random(jobs.size()));
    const Job job = std::move(*chosen);
    jobs.erase(chosen);
    job(static_cast<unsigned>(machine_.random(threads_)));
  }
  std::vector<Job> jobs;

 private:
  SimulatedMachine& machine_;
  TaskId self_;
  unsigned threads_ = 1;
};

struct SimulatedMachine::Running {
  Running(SimulatedMachine& machine, TaskId self, const std::string& hostName)
      : link(machine, self), host(hostName) {}
  Inside link;
  std::string host;
  std::unique_ptr<SimulatedTask> task;
  bool hangs = false;
  bool mayWork = false;
};

SimulatedMachine::SimulatedMachine(const Options& options)
    : options_(options), state_(mixBits(options.seed)) {}
SimulatedMachine::~SimulatedMachine() = default;

std::uint64_t SimulatedMachine::random(std::uint64_t below) {
  state_ = mixBits(state_);
  return state_ % below;
}

Spawned SimulatedMachine::spawn(Role role, const std::string& host) {
  const TaskId id{nextTask_++};
  auto running = std::make_unique<Running>(*this, id, host);
  running->task = makeTask(role, running->link);
  if (!running->task) return {kNobody, std::string("no such program: ") + programName(role)};
  tasks_[id] = std::move(running);
  return {id, ""};
}

void SimulatedMachine::sendFrom(TaskId from, TaskId to, std::span<const std::byte> packet) {
  if (to != kHost && !tasks_.contains(to)) return;
  enqueue(from, to, {LinkEvent::Kind::packet, from, "", Bytes(packet.begin(), packet.end())});
}

void SimulatedMachine::enqueue(TaskId from, TaskId to, LinkEvent event) {
  const std::size_t waiting = channels_.add({from, to}, std::move(event));
  if (options_.largestQueue > 0 && waiting > options_.largestQueue)
    throw std::runtime_error("simulated machine: a queue grows beyond its bound");
}

void SimulatedMachine::kill(TaskId task) { bury(task, random(2) == 0); }

void SimulatedMachine::bury(TaskId task, bool losesWords) {
  if (tasks_.erase(task) == 0) return;
  std::function<std::size_t(std::size_t)> keep;
  if (losesWords) keep = [this](std::size_t size) { return static_cast<std::size_t>(random(size + 1)); };
  channels_.cut(task, keep);
  // The notice comes after the last words that still arrive.
  for (TaskId watcher : watchers_[task]) enqueue(task, watcher, {LinkEvent::Kind::taskExit, task, "", {}});
  watchers_.erase(task);
}

// Kills a task, or makes one hang, when the time has come.
void SimulatedMachine::injectFault() {
  if (deaths_ >= options_.mostDeaths || tasks_.empty()) return;
  const bool death = options_.movesPerDeath > 0 && random(options_.movesPerDeath) == 0;
  const bool hang = options_.movesPerHang > 0 && random(options_.movesPerHang) == 0;
  if (!death && !hang) return;
  ++deaths_;
  const auto victim = std::next(tasks_.begin(), static_cast<long>(random(tasks_.size())));
  if (hang) {
    victim->second->hangs = true;
  } else {
    bury(victim->first, true);
  }
}

std::optional<LinkEvent> SimulatedMachine::deliver(const Channels::Channel& channel) {
  if (beforeDelivery) {
    beforeDelivery(channel.from, channel.to, channels_.queues().at(channel).front().bytes);
    if (!channels_.queues().contains(channel)) return std::nullopt;
  }
  LinkEvent event = channels_.take(channel);
  if (channel.to == kHost) return event;
  const auto to = tasks_.find(channel.to);
  if (to == tasks_.end()) return std::nullopt;
  to->second->task->receive(event);
  to->second->mayWork = true;
  if (to->second->task->finished()) {
    to->second->task->flush();
    bury(channel.to, false);
  }
  return std::nullopt;
}

// One move.  False: nothing can move.
bool SimulatedMachine::move(std::optional<LinkEvent>& forHost) {
  ++moves_;
  time_ += kMoveSeconds;
  injectFault();
  std::vector<Channels::Channel> open;
  for (const auto& [channel, queue] : channels_.queues()) {
    const auto to = tasks_.find(channel.to);
    if (channel.to == kHost || (to != tasks_.end() && !to->second->hangs)) open.push_back(channel);
  }
  std::vector<Running*> busy;
  for (const auto& [id, running] : tasks_)
    if ((running->mayWork || !running->link.jobs.empty()) && !running->hangs) busy.push_back(running.get());
  if (open.empty() && busy.empty()) return false;
  const std::uint64_t choice = random(open.size() + busy.size());
  if (choice < open.size()) {
    forHost = deliver(open[choice]);
  } else {
    Running& running = *busy[choice - open.size()];
    if (!running.link.jobs.empty() && (!running.mayWork || random(2) == 0)) {
      running.link.doOne();
      running.task->receive({LinkEvent::Kind::jobDone, running.link.self(), "", {}});
      running.mayWork = true;
      return true;
    }
    running.mayWork = running.task->work(time_ + 1e-7 * static_cast<double>(random(20)));
    if (!running.mayWork || random(4) == 0) running.task->flush();
  }
  return true;
}

std::optional<LinkEvent> SimulatedMachine::poll() {
  for (const auto& [channel, queue] : channels_.queues())
    if (channel.to == kHost && random(2) == 0) return deliver(Channels::Channel(channel));
  return std::nullopt;
}

std::optional<LinkEvent> SimulatedMachine::wait(double seconds) {
  std::optional<LinkEvent> event;
  const double deadline = time_ + seconds;
  while (time_ < deadline) {
    if (!move(event)) {
      // Nothing moves by itself: the host's patience ends.
      if (++idleWaits_ > 10000) throw std::runtime_error("simulated machine: nothing moves any more");
      time_ = deadline;
      return std::nullopt;
    }
    if (event) {
      idleWaits_ = 0;
      return event;
    }
  }
  return std::nullopt;
}

}  // namespace rayshade
