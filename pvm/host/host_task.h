// The host task (Reinhard & Jansen, figure 2): the life of a frame.
//
// It starts the slave tasks (roster.h), decides who gets which part of the model and streams it to them (shipping.h), sends
// the samples of the picture to those who trace them and takes in the colours (issuing.h), and hands the rows of the
// picture on as they are finished.  It never holds the model.
//
// Work enters here only, at most `window` samples at a time; that bounds every queue and buffer of the system.  When
// anything dies, successors are started, their share is shipped again and a new epoch begins: old messages are refused
// and the samples that were on their way are issued again.  Start-up is the same path, with nothing on its way.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "pvm/host/image_shipping.h"
#include "pvm/host/issuing.h"
#include "pvm/host/roster.h"
#include "pvm/messages/inbox.h"
#include "rayshade/events/event_file.h"
#include "rayshade/space/survey.h"

namespace rayshade {

class HostTask {
 public:
  using Accepted = TypeList<ItemsTaken, Ready, Report, Pong, Load, Answer, SampleColors, TileDone,
                            PyramidWanted, ImageTaken, Observed>;
  // Reads the scene once more, from the beginning, into a sink.
  using SceneReader = std::function<void(SceneSink&)>;

  // `survey`: of the first frame, or of any when nothing moves.
  HostTask(Machine& machine, SceneReader readScene, Survey survey, const SceneSettings& settings,
           const HostOptions& options);

  // Events are wanted: so many of each task at most, in lanes that are handed on when their tasks end, the host's at last.  To be
  // called before any frame.
  void observe(std::size_t most, std::function<void(const EventLane&)> lane);
  // Renders a frame of the animation; rows from top to bottom.  Throws HostError, and what the scene reader throws.
  void renderFrame(const View& view, const PictureSpec& picture, std::int32_t frame,
                   const std::function<void(const std::vector<Color>&)>& row,
                   const std::function<void(const Completed&)>& progress = {});
  const Traffic& traffic() const { return outbox_.traffic; }
  // Ends the tasks and gathers their reports.
  HostSummary finish();

  Epoch epoch() const { return configuration_.epoch; }
  void on(TaskId from, ItemsTaken);
  void on(TaskId from, Ready message);
  void on(TaskId from, Report message);
  void on(TaskId from, Observed message);
  void on(TaskId, Pong) {}
  void on(TaskId from, ImageTaken message) { outbox_.traffic.refused += !images_.arrive(from, message); }
  void on(TaskId from, Load message);
  void on(TaskId, Answer message) { issuing_.arrive(message.record, message.color); }
  void on(TaskId, const SampleColors& message);
  void on(TaskId from, const TileDone& message);
  void on(TaskId from, PyramidWanted) { issuing_.wanted(from); }

 private:
  void divide();
  void reconfigure();
  void ship();
  bool bringImages();
  bool configure();
  void sendWeights();
  void takeEvents(double patience);
  void handle(const LinkEvent& event);
  void receive(const LinkEvent& packet);

  Machine& machine_;
  SceneReader readScene_;
  HostOptions options_;
  Outbox outbox_;
  Roster roster_;
  ImageShipping images_;
  Survey survey_;
  Configure configuration_;  // what all slaves are told
  Issuing issuing_;
  bool rendering_ = false;  // else tasks are given time to read and to build
  double weighed_ = 0;      // when the weights of shade tasks were sent last
  HostSummary summary_;

  std::unique_ptr<EventRecord> record_;  // null: nothing is noted
  std::size_t mostEvents_ = 0;
  std::function<void(const EventLane&)> lane_;
  std::unordered_map<std::int32_t, std::uint32_t> packetsFrom_;
};

}  // namespace rayshade
