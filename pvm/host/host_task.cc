// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/host/host_task.h"

#include <algorithm>
#include <cmath>

#include "pvm/host/shipping.h"
#include "pvm/messages/task_context.h"
#include "pvm/schedule/division.h"
#include "rayshade/base/arithmetic.h"
#include "rayshade/base/interruption.h"
#include "rayshade/trace/render.h"

namespace rayshade {
namespace {

constexpr double kLoadEvery = 0.2;  // seconds

// A slave that cannot take part is no use to any epoch.
void check(const Ready& message, const Slave& slave, const HostOptions& options) {
  if (message.arithmetic != arithmeticFingerprint() && !options.mixedArithmetic)
    throw HostError(
        "host " + slave.placement.host +
        " computes other bits than this one (another processor?): the picture would depend on who traced "
        "what; --mixed goes on all the same");
  if (message.leftOut > 0)
    throw HostError("task " + std::string(programName(slave.placement.role)) + " on " + slave.placement.host +
                    " got items that do not fit together: " + std::to_string(message.leftOut));
}

}  // namespace

HostTask::HostTask(Machine& machine, SceneReader readScene, Survey survey, const SceneSettings& settings,
                   const HostOptions& options)
    : machine_(machine),
      readScene_(std::move(readScene)),
      options_(options),
      outbox_(machine),
      roster_(machine, options_),
      images_(outbox_, roster_, machine.hosts()[0].name, [this] { takeEvents(1); }),
      survey_(std::move(survey)),
      issuing_(outbox_, configuration_, options_) {
  configuration_.settings = settings;
  configuration_.policy = options.policy;
  configuration_.request.seed = options.seed;
  configuration_.threads = options.threads;
  configuration_.loadEvery = options.dynamicShading ? kLoadEvery : 0.0;
  summary_.objects = survey_.objects;
  summary_.host.placement = {Role::host, 0, machine.hosts()[0].name, {}};
  summary_.host.task = machine.self();
}

void HostTask::observe(std::size_t most, std::function<void(const EventLane&)> lane) {
  record_ = std::make_unique<EventRecord>(most);
  outbox_.record = record_.get();
  mostEvents_ = most;
  lane_ = std::move(lane);
  roster_.onDeath = [this](TaskId task) { outbox_.note(EventKind::death, task, 0, 0, 0); };
}

// ---- the picture

void HostTask::renderFrame(const View& view, const PictureSpec& picture, std::int32_t frame,
                           const std::function<void(const std::vector<Color>&)>& row,
                           const std::function<void(const Completed&)>& progress) {
  configuration_.request.view = view;
  configuration_.request.picture = picture;
  configuration_.exposure = exposureOf(picture, frame);
  divide();
  issuing_.beginFrame();
  reconfigure();
  const double begin = machine_.now();
  Sampler& sampler = issuing_.sampler();
  std::vector<Color> colors;
  while (!sampler.finished()) {
    while (sampler.takeRow(colors)) row(colors);
    if (sampler.finished()) break;
    if (!roster_.complete()) reconfigure();
    issuing_.issue();
    summary_.peakInFlight = std::max<std::uint64_t>(summary_.peakInFlight, issuing_.inFlight());
    if (options_.dynamicShading) sendWeights();
    if (progress) progress(sampler.completed());
    takeEvents(1);
  }
  summary_.notFinite += sampler.counts().notFinite;
  issuing_.endFrame();
  summary_.traceSeconds += machine_.now() - begin;
}

// Cuts space for the frame; what the tasks hold is of another division then.
void HostTask::divide() {
  if (survey_.moves) {
    const double begin = machine_.now();
    SurveySink sink(configuration_.exposure);
    readScene_(sink);
    survey_ = sink.survey();
    summary_.surveySeconds += machine_.now() - begin;
  }
  Directory& directory = configuration_.directory;
  directory.clusters = std::max(1u, options_.wishes.clusters);
  std::vector<Placement> placements;
  for (const Slave& slave : roster_.slaves()) placements.push_back(slave.placement);
  const std::vector<TaskPlace> places = placesOfVoxelTasks(machine_.hosts(), placements, options_.wishes);
  Division division = divideSpace(survey_, configuration_.request, configuration_.settings, options_, places);
  if (const std::string problem = whatDoesNotFit(division, places); !problem.empty())
    throw HostError(problem);
  configuration_.tree = std::move(division.tree);
  directory.voxels = std::move(division.owners);
  for (Slave& slave : roster_.slaves()) slave.hasItems = false;
}

// Dynamic placement of shading, every so often.
void HostTask::sendWeights() {
  const double now = machine_.now();
  if (now - weighed_ < kLoadEvery) return;
  weighed_ = now;
  const Weights weights{epoch(), weighShadeTasks(roster_.slaves())};
  for (const Slave& slave : roster_.slaves())
    if (slave.placement.role != Role::shade && slave.task != kNobody) outbox_.post(slave.task, weights);
}

HostSummary HostTask::finish() {
  rendering_ = false;
  for (Slave& slave : roster_.slaves()) {
    slave.heard = machine_.now();
    if (slave.task != kNobody) outbox_.post(slave.task, Finish{});
  }
  auto missing = [&](const Slave& s) {
    return s.task != kNobody && !(s.reported && (s.observed || !record_));
  };
  const double deadline = machine_.now() + options_.killAfter;
  while (std::ranges::any_of(roster_.slaves(), missing) && machine_.now() < deadline) takeEvents(1);
  // Those who have reported leave by themselves.
  const double farewell = machine_.now() + 2;
  while (!roster_.deserted() && machine_.now() < farewell) takeEvents(0.1);
  for (Slave& slave : roster_.slaves()) {
    if (slave.task != kNobody) machine_.kill(slave.task);
    slave.summary.placement = slave.placement;
    summary_.tasks.push_back(slave.summary);
  }
  summary_.successions = roster_.successions();
  addTo(summary_.host.report, outbox_.traffic);
  addTo(summary_.host.report, machine_.usage());
  if (record_)
    lane_({static_cast<std::int32_t>(machine_.self()), "host", 0, summary_.host.placement.host, 0,
           record_->log()});
  return summary_;
}

// ---- an epoch

// Start-up and recovery: brings all tasks into a new epoch, whatever dies meanwhile.
void HostTask::reconfigure() {
  const double begin = machine_.now();
  rendering_ = false;
  do {
    for (const TaskId begun : roster_.startMissing()) {
      if (!record_) continue;
      roster_.find(begun)->observedFrom = machine_.now();
      outbox_.post(begun, Observe{static_cast<std::uint32_t>(mostEvents_)});
    }
    enlist(roster_.slaves(), configuration_.directory);
    ship();
  } while (!bringImages() || !roster_.complete() || !configure());
  rendering_ = true;
  summary_.startSeconds += machine_.now() - begin;
}

// Reads the scene once for all voxel tasks that have no items.
void HostTask::ship() {
  const std::vector<Slave*> voxelTasks = roster_.slavesOf(Role::voxelTrace);
  std::set<std::uint32_t> targets;
  for (std::uint32_t number = 0; number < voxelTasks.size(); ++number) {
    if (voxelTasks[number]->hasItems) continue;
    targets.insert(number);
    outbox_.post(voxelTasks[number]->task, Forget{});
  }
  if (targets.empty()) return;
  for (std::uint32_t number : targets) voxelTasks[number]->hasItems = true;  // until it turns out otherwise
  Shipping shipping(
      configuration_, targets,
      [&](std::uint32_t number, Items&& batch) {
        Slave& slave = *voxelTasks[number];
        while (slave.task != kNobody && slave.batchesOut >= Shipping::kBatches) takeEvents(1);
        if (slave.task == kNobody) return;  // died meanwhile: its successor gets all of it
        ++slave.batchesOut;
        outbox_.post(slave.task, batch);
      },
      [&](std::uint32_t number, const Image& image) { images_.bring(*voxelTasks[number], image); });
  readScene_(shipping.sink());
  shipping.finish();
  for (std::uint32_t number : targets)
    if (voxelTasks[number]->task == kNobody) voxelTasks[number]->hasItems = false;
}

// Whoever gets cells of others gets all images.  False: some task must be shipped to again.
bool HostTask::bringImages() {
  for (Slave& slave : roster_.slaves()) {
    const Role role = slave.placement.role;
    const bool fetches = role == Role::pyramidTrace ||
                         (role == Role::voxelTrace && options_.policy.shadows != ShadowPolicy::forward);
    if (fetches) images_.bringAll(slave);
  }
  return images_.settle();
}

// Tells everybody of the new epoch and waits until all are ready; nothing of the new epoch exists before.  False: a
// task died.
bool HostTask::configure() {
  configuration_.epoch = Epoch{static_cast<std::uint32_t>(epoch()) + 1};
  ++summary_.epochs;
  outbox_.beginEpoch(epoch());
  summary_.reissued += issuing_.recall();
  std::vector<TaskId> tasks;
  for (Slave& slave : roster_.slaves()) {
    slave.ready = false;
    tasks.push_back(slave.task);
  }
  outbox_.postToAll(tasks, configuration_);
  outbox_.flush();
  while (roster_.complete() && !std::ranges::all_of(roster_.slaves(), &Slave::ready)) takeEvents(1);
  issuing_.beginEpoch();
  return roster_.complete();
}

// ---- events

// Lets out what has gathered, then takes in what is there; waits up to `patience` seconds for a first event.
void HostTask::takeEvents(double patience) {
  checkInterruption();
  outbox_.flush();
  const double begin = machine_.now();
  auto first = machine_.wait(patience);
  if (record_)
    record_->span(issuing_.inFlight() > 0 ? EventKind::wait : EventKind::idle, begin, machine_.now());
  if (first) {
    handle(*first);
    while (auto event = machine_.poll()) handle(*event);
  }
  roster_.lookAfterSilent(outbox_, rendering_ ? options_.killAfter : options_.patienceAtStart);
}

void HostTask::handle(const LinkEvent& event) {
  Slave* const slave = roster_.find(event.task);
  switch (event.kind) {
    case LinkEvent::Kind::packet:
      if (slave != nullptr) {
        slave->heard = machine_.now();
        slave->pinged = false;
        receive(event);
      } else {
        ++outbox_.traffic.stale;  // last words of the dead
      }
      break;
    case LinkEvent::Kind::taskExit:
      if (slave != nullptr) roster_.bury(*slave, "its process ended, or its host is gone");
      break;
    case LinkEvent::Kind::hostExit:
      roster_.buryHost(event.host);
      break;
    case LinkEvent::Kind::hostJoined:
      break;  // it is there for the next successor
    case LinkEvent::Kind::jobDone:
      break;  // the host has no threads
  }
}

void HostTask::receive(const LinkEvent& event) {
  const std::uint64_t before = outbox_.traffic.messagesIn;
  const double begin = machine_.now();
  receivePacket(*this, event.task, event.bytes, outbox_.traffic);
  if (!record_) return;
  const auto from = static_cast<std::int32_t>(event.task);
  record_->add({nanoseconds(begin), nanoseconds(machine_.now()), EventKind::decode, 0, from,
                packetsFrom_[from]++, static_cast<std::uint32_t>(outbox_.traffic.messagesIn - before),
                event.bytes.size()});
}

void HostTask::on(TaskId from, ItemsTaken) {
  if (Slave* slave = roster_.find(from)) slave->batchesOut = std::max(0, slave->batchesOut - 1);
}

void HostTask::on(TaskId from, Ready message) {
  Slave* slave = roster_.find(from);
  if (slave == nullptr || message.epoch != epoch()) return;
  check(message, *slave, options_);
  slave->ready = true;
  slave->summary.objects = message.objects;
  slave->summary.owned = message.owned;
}

void HostTask::on(TaskId from, Report message) {
  if (Slave* slave = roster_.find(from)) {
    slave->summary.report = message;
    slave->reported = true;
  }
}

// Two bounds for what its clock is behind: Observe was on its way, and so was this.
void HostTask::on(TaskId from, Observed message) {
  Slave* slave = roster_.find(from);
  if (slave == nullptr || !record_) return;
  slave->observed = true;
  const double least = slave->observedFrom - message.begun, most = machine_.now() - message.now;
  const double behind = least <= 0 && most >= 0 ? 0 : (least + most) / 2;  // 0: it is the same clock
  lane_({static_cast<std::int32_t>(from), roleName(slave->placement.role), slave->placement.index,
         slave->placement.host, std::llround(1e9 * behind), std::move(message.log)});
}

void HostTask::on(TaskId from, Load message) {
  if (Slave* slave = roster_.find(from)) slave->busy = message.busy;
}

void HostTask::on(TaskId from, const TileDone& message) {
  outbox_.note(EventKind::taken, from, message.number, message.colors.samples, 0);
  outbox_.traffic.refused += !issuing_.arrive(message);
}

void HostTask::on(TaskId, const SampleColors& message) {
  RecordId record = message.first;
  for (const Color& color : message.colors) issuing_.arrive(record++, color);
}

}  // namespace rayshade
