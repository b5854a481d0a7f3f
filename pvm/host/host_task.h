// The host task (Reinhard & Jansen, figure 2).
//
// It starts the slave tasks, decides who gets which part of the model and streams it to them, sends the samples of
// the picture to the task of the voxel in which their rays begin, collects the colours, and hands the rows of the picture on as they are
// finished.  It never holds the model.
//
// Work enters here only, at most `window` samples at a time; that bounds every queue and buffer of the system.  When
// anything dies, successors are started, their share is shipped again and a new epoch begins: old messages are refused
// and the samples that were on their way are issued again.  Start-up is the same path, with nothing on its way.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <stdexcept>

#include "pvm/host/in_flight.h"
#include "pvm/host/shipping.h"
#include "pvm/messages/inbox.h"
#include "pvm/schedule/options.h"
#include "rayshade/sampling/sampler.h"
#include "rayshade/space/survey.h"
#include "rayshade/space/walk.h"
#include "rayshade/space/voxel_bounds.h"
#include "rayshade/trace/render.h"

namespace rayshade {

struct TaskSummary {
  Placement placement;
  TaskId task = kNobody;
  std::uint64_t objects = 0, owned = 0;
  Report report;
};

struct HostSummary {
  TaskSummary host;                // its traffic, CPU time and memory
  std::vector<TaskSummary> tasks;  // the others
  std::uint64_t objects = 0;       // of the world
  int successions = 0;             // tasks that died and were replaced
  std::uint32_t epochs = 0;
  std::uint64_t peakInFlight = 0;
  std::uint64_t reissued = 0;                                    // samples issued again
  double surveySeconds = 0, startSeconds = 0, traceSeconds = 0;  // start: shipping and building
};

class HostTask {
 public:
  using Accepted = TypeList<ItemsTaken, Ready, Report, Pong, Load, Answer, SampleColors, PyramidWanted>;
  // Reads the scene once more, from the beginning, into a sink.
  using SceneReader = std::function<void(SceneSink&)>;
  struct Progress {
    std::int32_t rows = 0, allRows = 0;
    std::uint64_t samples = 0;
  };

  // `survey`: of the first frame, or of any when nothing moves.
  HostTask(Machine& machine, SceneReader scene, const Survey& survey, const SceneSettings& settings,
           const HostOptions& options);

  // Renders a frame of the animation; rows from top to bottom.  Throws HostError, and what the scene reader throws.
  void renderFrame(const View& view, const PictureSpec& picture, std::int32_t frame,
                   const std::function<void(const std::vector<Color>&)>& row,
                   const std::function<void(const Progress&)>& progress = {});
  // Ends the tasks and gathers their reports.
  HostSummary finish();

  Epoch epoch() const { return epoch_; }
  void on(TaskId from, ItemsTaken);
  void on(TaskId from, Ready message);
  void on(TaskId from, Report message);
  void on(TaskId from, Pong);
  void on(TaskId from, Answer message);
  void on(TaskId from, const SampleColors& message);
  void on(TaskId from, PyramidWanted);
  void on(TaskId from, Load message);

 private:
  enum class Phase : std::uint8_t { shipping, configuring, rendering, finishing };
  struct Slave {
    Placement placement;
    TaskId task = kNobody;  // kNobody: dead, or not started yet
    bool hasItems = false;
    int batchesOut = 0;  // shipped and not answered
    bool ready = false;
    double heard = 0;    // when it last said anything
    bool asked = false;  // a Ping is out
    TaskSummary summary;
    bool reported = false;
    double busy = 0;  // share of its time, as it said last
  };

  void surveyAgain();
  void placeTasks();
  void reconfigure();
  void arrive(RecordId record, Color color);
  bool startMissing();
  void ship();
  bool configure();
  bool nextSample(SampleId& sample);
  PrimaryRays takeSamples(std::size_t most);
  void issueRays();
  void issuePyramids();
  void handle(const LinkEvent& event);
  void takeEvents(double patience);
  void lookAfterSilent();
  void sendWeights();
  void lost(Slave& slave, const std::string& how);
  Slave* find(TaskId task);
  template <class M>
  void postAll(const M& message);

  Machine& machine_;
  SceneReader scene_;
  SceneSettings settings_;
  HostOptions options_;
  Outbox outbox_;
  Epoch epoch_{};
  Phase phase_ = Phase::shipping;

  std::vector<Slave> slaves_;
  std::map<std::int32_t, std::size_t> byTask_;
  BinTree tree_;
  Directory directory_;
  Exposure exposure_;
  Survey survey_;
  bool someoneDied_ = false;
  int successions_ = 0;
  std::string lastDeath_;  // who, where and how

  const View* view_ = nullptr;  // of the frame that is rendered
  const PictureSpec* picture_ = nullptr;
  Sampler* sampler_ = nullptr;
  InFlight inFlight_;
  std::deque<SampleId> again_;  // were on their way when something died
  std::deque<TaskId> wanting_;  // pyramid tasks that asked for work
  std::uint64_t runs_ = 0;      // of samples, sent to voxel tasks
  std::vector<std::uint32_t> cellBytes_;
  std::vector<Bounds> cellBounds_;
  double weighed_ = 0;  // when the weights of shade tasks were sent last
  HostSummary summary_;
};

}  // namespace rayshade
