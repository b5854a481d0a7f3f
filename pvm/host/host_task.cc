// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/host_task.h"

#include <algorithm>
#include <cmath>

#include "pvm/messages/task_context.h"
#include "pvm/schedule/division.h"
#include "rayshade/base/interruption.h"

namespace rayshade {
namespace {

// So many samples in a row go to the same task; with several clusters, to the same one.
constexpr std::size_t kRun = 64;
constexpr double kLoadEvery = 0.2;  // seconds

}  // namespace

HostTask::HostTask(Machine& machine, SceneReader scene, const Survey& survey, const SceneSettings& settings,
                   const HostOptions& options)
    : machine_(machine),
      scene_(std::move(scene)),
      settings_(settings),
      options_(options),
      outbox_(machine),
      survey_(survey) {
  summary_.objects = survey.objects;
  placeTasks();
}

// ---- who there is

void HostTask::placeTasks() {
  const std::vector<HostInfo> hosts = machine_.hosts();
  if (hosts.empty()) throw HostError("the virtual machine has no hosts");
  summary_.host.placement = {Role::host, 0, hosts[0].name, {}};
  summary_.host.task = machine_.self();
  for (const Placement& placement : mapProcesses(hosts, options_.wishes)) {
    Slave slave;
    slave.placement = placement;
    slaves_.push_back(slave);
  }
}

HostTask::Slave* HostTask::find(TaskId task) {
  const auto found = byTask_.find(static_cast<std::int32_t>(task));
  return found == byTask_.end() ? nullptr : &slaves_[found->second];
}

template <class M>
void HostTask::postAll(const M& message) {
  for (const Slave& slave : slaves_)
    if (slave.task != kNobody) outbox_.post(slave.task, message);
}

void HostTask::lost(Slave& slave, const std::string& how) {
  if (slave.task == kNobody) return;
  lastDeath_ = std::string(programName(slave.placement.role)) + " on " + slave.placement.host + ": " + how;
  byTask_.erase(static_cast<std::int32_t>(slave.task));
  slave.task = kNobody;
  slave.hasItems = false;
  slave.batchesOut = 0;
  slave.ready = false;
  someoneDied_ = true;
}

// Starts what is not there, first where the mapping puts it, then wherever there is a host.  False: nothing was missing.
bool HostTask::startMissing() {
  bool missing = false;
  for (std::size_t i = 0; i < slaves_.size(); ++i) {
    Slave& slave = slaves_[i];
    if (slave.task != kNobody) continue;
    missing = true;
    if (slave.summary.task != kNobody && ++successions_ > options_.mostSuccessions)
      throw HostError("tasks keep dying: given up after " + std::to_string(options_.mostSuccessions) +
                      " successors; the last to die was " + lastDeath_);
    const std::vector<HostInfo> hosts = machine_.hosts();
    const auto mapped = mapProcesses(hosts, options_.wishes);
    const bool stands = std::any_of(hosts.begin(), hosts.end(),
                                    [&](const HostInfo& h) { return h.name == slave.placement.host; });
    if (!stands && i < mapped.size()) slave.placement = mapped[i];
    Spawned spawned = machine_.spawn(slave.placement.role, slave.placement.host);
    for (std::size_t h = 0; spawned.task == kNobody && h < hosts.size(); ++h) {
      if (hosts[h].name == slave.placement.host) continue;
      const std::string problem = spawned.problem;
      spawned = machine_.spawn(slave.placement.role, hosts[h].name);
      if (spawned.task == kNobody)
        spawned.problem = problem;
      else
        slave.placement.host = hosts[h].name;
    }
    if (spawned.task == kNobody) throw HostError(spawned.problem);
    slave.task = spawned.task;
    slave.summary.task = spawned.task;
    slave.heard = machine_.now();
    slave.asked = false;
    byTask_[static_cast<std::int32_t>(spawned.task)] = i;
    machine_.watch(spawned.task);
  }
  return missing;
}

// ---- an epoch

// Start-up and recovery: brings all tasks into a new epoch, whatever dies meanwhile.
void HostTask::reconfigure() {
  const double begin = machine_.now();
  do {
    someoneDied_ = false;
    startMissing();
    phase_ = Phase::shipping;
    directory_.voxelTasks.clear();
    directory_.pyramidTasks.clear();
    directory_.shadeTasks.clear();
    for (const Slave& slave : slaves_) {
      (slave.placement.role == Role::voxelTrace     ? directory_.voxelTasks
       : slave.placement.role == Role::pyramidTrace ? directory_.pyramidTasks
                                                    : directory_.shadeTasks)
          .push_back(slave.task);
    }
    directory_.shadeWeights.assign(directory_.shadeTasks.size(), 1);
    ship();
  } while (someoneDied_ || !configure());
  phase_ = Phase::rendering;
  summary_.startSeconds += machine_.now() - begin;
  // Samples that were on their way are issued again; they are pure, so the same bits come back.
  summary_.reissued += inFlight_.size();
  for (const SampleId& sample : inFlight_.takeAll()) again_.push_back(sample);
}

void HostTask::surveyAgain() {
  const double begin = machine_.now();
  SurveySink sink(exposure_);
  scene_(sink);
  survey_ = sink.survey();
  summary_.surveySeconds += machine_.now() - begin;
}

// Reads the scene once for all tasks that have no items.
void HostTask::ship() {
  std::set<std::uint32_t> targets;  // numbers of voxel tasks, over all clusters
  std::uint32_t number = 0;
  std::vector<std::size_t> slaveOf;
  for (std::size_t i = 0; i < slaves_.size(); ++i) {
    if (slaves_[i].placement.role != Role::voxelTrace) continue;
    if (!slaves_[i].hasItems) {
      targets.insert(number);
      outbox_.post(slaves_[i].task, Forget{});
    }
    slaveOf.push_back(i);
    ++number;
  }
  if (targets.empty()) return;
  Shipping* shipping = nullptr;
  cellBytes_.assign(cellCount(tree_), 0);
  cellBounds_.assign(cellCount(tree_), Bounds{});
  std::vector<CellId> cells;
  ObjectStream stream(exposure_, [&](const SceneObject& object, const Bounds& bounds,
                                     std::span<const NodeItem* const> nodes) {
    cells.clear();
    cellsTouching(tree_, bounds, cells);
    const auto bytes = static_cast<std::uint32_t>(Shipping::bytesOf(object));
    for (CellId cell : cells) {
      const auto at = static_cast<std::size_t>(cell);
      cellBytes_[at] += bytes;
      cellBounds_[at] = join(cellBounds_[at], boundsInCell(bounds, tree_, cell));
    }
    shipping->object(object, bounds, nodes);
  });
  Shipping pass(stream, tree_, directory_, targets, [&](std::uint32_t task, Items&& batch) {
    Slave& slave = slaves_[slaveOf[task]];
    while (slave.task != kNobody && slave.batchesOut >= Shipping::kBatches) takeEvents(1);
    if (slave.task == kNobody) return;  // died meanwhile: its successor gets all of it
    ++slave.batchesOut;
    outbox_.post(slave.task, batch);
  });
  shipping = &pass;
  scene_(stream);
  pass.finish();
  for (std::uint32_t task : targets)
    if (slaves_[slaveOf[task]].task != kNobody) slaves_[slaveOf[task]].hasItems = true;
}

// Tells everybody of the new epoch and waits until all are ready; nothing of the new epoch exists before.  False: a
// task died.
bool HostTask::configure() {
  phase_ = Phase::configuring;
  epoch_ = Epoch{static_cast<std::uint32_t>(epoch_) + 1};
  ++summary_.epochs;
  outbox_.beginEpoch(epoch_);
  wanting_.clear();
  for (Slave& slave : slaves_) {
    slave.ready = false;
    outbox_.post(slave.task, Configure{epoch_,
                                       settings_,
                                       tree_,
                                       directory_,
                                       slave.placement.index,
                                       exposure_,
                                       options_.policy,
                                       {*view_, *picture_, options_.seed},
                                       cellBytes_,
                                       cellBounds_,
                                       options_.dynamicShading ? kLoadEvery : 0.0});
  }
  outbox_.flush();
  std::vector<TaskId> peers;
  for (const Slave& slave : slaves_) peers.push_back(slave.task);
  machine_.connect(peers);
  while (!someoneDied_ &&
         !std::all_of(slaves_.begin(), slaves_.end(), [](const Slave& s) { return s.ready; }))
    takeEvents(1);
  return !someoneDied_;
}

// ---- events

void HostTask::handle(const LinkEvent& event) {
  switch (event.kind) {
    case LinkEvent::Kind::packet:
      if (Slave* slave = find(event.task)) {
        slave->heard = machine_.now();
        slave->asked = false;
        receivePacket(*this, event.task, event.bytes, outbox_.traffic);
      } else {
        ++outbox_.traffic.stale;  // last words of the dead
      }
      break;
    case LinkEvent::Kind::taskExit:
      if (Slave* slave = find(event.task)) lost(*slave, "its process ended, or its host is gone");
      break;
    case LinkEvent::Kind::hostExit:
      for (Slave& slave : slaves_)
        if (slave.placement.host == event.host) lost(slave, "its host left the virtual machine");
      break;
    case LinkEvent::Kind::hostJoined:
      break;  // it is there for the next successor
  }
}

// Lets out what has gathered, then takes in what is there; waits up to `patience` seconds for a first event.
void HostTask::takeEvents(double patience) {
  checkInterruption();
  outbox_.flush();
  if (auto first = machine_.wait(patience)) {
    handle(*first);
    while (auto event = machine_.poll()) handle(*event);
  }
  lookAfterSilent();
}

void HostTask::lookAfterSilent() {
  const double now = machine_.now();
  const double most = phase_ == Phase::rendering ? options_.killAfter : options_.patienceAtStart;
  for (Slave& slave : slaves_) {
    if (slave.task == kNobody) continue;
    const double silence = now - slave.heard;
    if (silence > options_.pingAfter && !slave.asked) {
      outbox_.post(slave.task, Ping{});
      slave.asked = true;
    }
    if (silence > most && slave.asked) {
      machine_.kill(slave.task);
      lost(slave, "no answer for " + std::to_string(std::lround(silence)) + " s");
    }
  }
}

void HostTask::on(TaskId from, ItemsTaken) {
  if (Slave* slave = find(from)) slave->batchesOut = std::max(0, slave->batchesOut - 1);
}

void HostTask::on(TaskId from, Ready message) {
  Slave* slave = find(from);
  if (slave == nullptr || message.epoch != epoch_) return;
  if (message.arithmetic != arithmeticFingerprint() && !options_.mixedArithmetic)
    throw HostError(
        "host " + slave->placement.host +
        " computes other bits than this one (another processor?): the picture would depend on who traced "
        "what; --mixed goes on all the same");
  if (message.leftOut > 0)
    throw HostError("task " + std::string(programName(slave->placement.role)) + " on " +
                    slave->placement.host +
                    " got items that do not fit together: " + std::to_string(message.leftOut));
  slave->ready = true;
  slave->summary.objects = message.objects;
  slave->summary.owned = message.owned;
}

void HostTask::on(TaskId from, Report message) {
  if (Slave* slave = find(from)) {
    slave->summary.report = message;
    slave->reported = true;
  }
}

void HostTask::on(TaskId, Pong) {}

void HostTask::on(TaskId, Answer message) { arrive(message.record, message.color); }

void HostTask::on(TaskId, const SampleColors& message) {
  RecordId record = message.first;
  for (const Color& color : message.colors) arrive(record++, color);
}

void HostTask::arrive(RecordId record, Color color) {
  const std::optional<SampleId> sample = inFlight_.take(record);
  if (sample && sampler_ != nullptr) sampler_->supply(*sample, color);
}

void HostTask::on(TaskId from, PyramidWanted) { wanting_.push_back(from); }

void HostTask::on(TaskId from, Load message) {
  if (Slave* slave = find(from)) slave->busy = message.busy;
}

// Dynamic placement of shading: the less a shade task's machine has to do, the more intersections it gets.
void HostTask::sendWeights() {
  const double now = machine_.now();
  if (now - weighed_ < kLoadEvery) return;
  weighed_ = now;
  std::map<std::string, double> busy;  // by machine
  for (const Slave& slave : slaves_) busy[slave.placement.host] += slave.busy;
  Weights weights{epoch_, {}};
  for (const Slave& slave : slaves_) {
    if (slave.placement.role != Role::shade) continue;
    const double load = busy[slave.placement.host] + 2 * slave.busy;
    weights.shadeWeights.push_back(static_cast<std::uint32_t>(1000 / (0.1 + load)));
  }
  for (const Slave& slave : slaves_)
    if (slave.placement.role != Role::shade && slave.task != kNobody) outbox_.post(slave.task, weights);
}

// ---- the picture

bool HostTask::nextSample(SampleId& sample) {
  // One that is slow must not let the others run away from it.
  constexpr std::size_t kMostSpan = 64;  // windows
  if (inFlight_.size() >= options_.window || inFlight_.span() >= kMostSpan * options_.window) return false;
  if (!again_.empty()) {
    sample = again_.front();
    again_.pop_front();
    return true;
  }
  return sampler_->next(sample);
}

// The next samples, up to `most`, as one message.
PrimaryRays HostTask::takeSamples(std::size_t most) {
  PrimaryRays work;
  work.firstRecord = inFlight_.next();
  SampleId sample;
  while (work.samples.size() < most && nextSample(sample)) {
    inFlight_.add(sample);
    work.samples.push_back(sample);
  }
  return work;
}

// Data driven: to the task of the voxel in which the rays begin.  Rays of a lens may begin in another one: then they
// are handed on there.
void HostTask::issueRays() {
  for (;;) {
    const PrimaryRays work = takeSamples(kRun);
    if (work.samples.empty()) return;
    const Ray ray =
        primaryRay(FrameRequest{*view_, *picture_, options_.seed}, exposure_, work.samples.front());
    VoxelWalk walk(tree_, ray.origin, ray.direction);
    WalkStep<VoxelId> first;
    walk.next(first);
    const auto cluster = static_cast<std::uint32_t>(runs_++ % directory_.clusters);
    outbox_.post(directory_.ownerOf(first.where, cluster), work);
  }
}

// Demand driven: a tile for each pyramid task that asked.
void HostTask::issuePyramids() {
  while (!wanting_.empty()) {
    const PrimaryRays work = takeSamples(options_.tileSamples);
    if (work.samples.empty()) return;
    outbox_.post(wanting_.front(), work);
    wanting_.pop_front();
  }
}

void HostTask::renderFrame(const View& view, const PictureSpec& picture, std::int32_t frame,
                           const std::function<void(const std::vector<Color>&)>& row,
                           const std::function<void(const Progress&)>& progress) {
  view_ = &view;
  picture_ = &picture;
  exposure_ = exposureOf(picture, frame);
  if (survey_.moves) surveyAgain();
  const auto voxelTasks = static_cast<std::uint32_t>(std::count_if(
      slaves_.begin(), slaves_.end(), [](const Slave& s) { return s.placement.role == Role::voxelTrace; }));
  directory_.clusters = std::max(1u, options_.wishes.clusters);
  Division division =
      divideSpace(survey_, {view, picture, settings_}, options_, voxelTasks / directory_.clusters);
  tree_ = std::move(division.tree);
  directory_.voxels = std::move(division.owners);
  for (Slave& slave : slaves_) slave.hasItems = false;

  Sampler sampler(picture, options_.seed, static_cast<std::uint32_t>(frame));
  sampler_ = &sampler;
  inFlight_.takeAll();
  again_.clear();
  reconfigure();
  const double begin = machine_.now();
  Progress state{0, sampler.area().height, 0};
  std::vector<Color> colors;
  while (!sampler.finished()) {
    while (sampler.takeRow(colors)) {
      row(colors);
      ++state.rows;
    }
    if (sampler.finished()) break;
    if (someoneDied_) reconfigure();
    if (directory_.pyramidTasks.empty()) {
      issueRays();
    } else {
      issuePyramids();
    }
    summary_.peakInFlight = std::max<std::uint64_t>(summary_.peakInFlight, inFlight_.size());
    if (options_.dynamicShading) sendWeights();
    state.samples = sampler.counts().given;
    if (progress) progress(state);
    takeEvents(1);
  }
  sampler_ = nullptr;
  inFlight_.takeAll();
  summary_.traceSeconds += machine_.now() - begin;
}

HostSummary HostTask::finish() {
  phase_ = Phase::finishing;
  for (Slave& slave : slaves_) slave.heard = machine_.now();
  postAll(Finish{});
  auto missing = [](const Slave& s) { return s.task != kNobody && !s.reported; };
  const double deadline = machine_.now() + options_.killAfter;
  while (std::any_of(slaves_.begin(), slaves_.end(), missing) && machine_.now() < deadline) takeEvents(1);
  // Those who have reported leave by themselves.
  const double farewell = machine_.now() + 2;
  while (!byTask_.empty() && machine_.now() < farewell) takeEvents(0.1);
  for (Slave& slave : slaves_) {
    if (slave.task != kNobody) machine_.kill(slave.task);
    slave.summary.placement = slave.placement;
    summary_.tasks.push_back(slave.summary);
  }
  summary_.successions = successions_;
  summary_.host.report = reportOf(outbox_.traffic);
  return summary_;
}

}  // namespace rayshade
