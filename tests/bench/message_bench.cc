// What it costs to say something: each kind of message of the inner loop, put into a packet, taken out again and handled.
//
//   bin/bench/message_bench            nanoseconds and bytes a message, without the link itself (see link_bench)
// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include "pvm/messages/inbox.h"
#include "pvm/shade/shade_task.h"
#include "rayshade/sampling/sampler.h"
#include "tests/support/null_link.h"

namespace rayshade {
namespace {

constexpr std::size_t kMessages = 256;  // in a packet

// Keeps what a task sends.
class KeepingLink : public NullLink {
 public:
  void send(TaskId, std::span<const std::byte> packet) override {
    sent.emplace_back(packet.begin(), packet.end());
  }
  std::vector<Bytes> sent;
};

struct Sink {
  using Accepted = TypeList<RayTask, ShadowTask, Answer, LightAnswers, Expect>;
  Epoch epoch() const { return Epoch{1}; }
  template <class M>
  void on(TaskId, M&& message) {
    benchmark::DoNotOptimize(&message);
  }
};

RayTask rayTask() {
  RayTask task;
  task.ray.origin = {1, 2, 3};
  task.ray.direction = {0.6, 0.8, 0};
  task.ray.depth = 1;
  task.ray.contribution = {.3, .3, .3};
  task.to = {TaskId{7}, 12345, kReflectedSlot};
  return task;
}

ShadowTask shadowTask() {
  ShadowTask task;
  task.head.shader = TaskId{7};
  task.head.record = 12345;
  for (Slot slot = 0; slot < 2; ++slot)
    task.rays.push_back({slot, 1, {1, 2, 3}, {0.6, 0.8, 0}, 12.5, kWhite, 0, 1, false});
  return task;
}

// Three lights, of which one is dark and `pending` are awaited.
Expect expectation(RecordId record, std::size_t pending, bool reflected) {
  Expect e;
  e.record = record;
  e.to = {TaskId{3}, 77, 0};
  e.hit.position = {1, 2, 3};
  e.hit.direction = {0.6, 0.8, 0};
  e.hit.normal = {0, 0, 1};
  e.hit.surface.diffuse = {.5, .45, .35};
  e.hit.surface.specular = {.5, .5, .5};
  e.hit.visibility.assign(3);
  e.gathered.light.assign(3);
  for (std::size_t i = 0; i < 3; ++i) e.hit.visibility[i] = LightVisibility::traced;
  for (std::size_t i = 0; i < pending; ++i) e.pending.push_back(static_cast<Slot>(i));
  e.hit.back.reflected = reflected;
  e.hit.back.reflectWeight = {.5, .5, .5};
  return e;
}

// Rays and answers have records that follow each other, as they have when a bundle leaves a task.
template <class M>
void postMany(Outbox& outbox, M message) {
  for (std::size_t i = 0; i < kMessages; ++i) {
    if constexpr (requires { message.to.record; }) ++message.to.record;
    if constexpr (std::is_same_v<M, Answer>) ++message.record;
    outbox.post(TaskId{2}, message);
  }
  outbox.flush();
}

template <class M>
Bytes packetOf(const M& message) {
  KeepingLink link;
  Outbox outbox(link);
  outbox.beginEpoch(Epoch{1});
  postMany(outbox, message);
  return link.sent.front();
}

template <class M>
void report(benchmark::State& state, const M&, std::size_t bytes) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kMessages));
  state.counters["bytes"] = static_cast<double>(bytes) / kMessages;
}

template <class M>
void write(benchmark::State& state, const M& message) {
  NullLink link;
  Outbox outbox(link);
  outbox.beginEpoch(Epoch{1});
  for (auto _ : state) {
    postMany(outbox, message);
  }
  report(state, message, packetOf(message).size());
}

template <class M>
void read(benchmark::State& state, const M& message) {
  const Bytes packet = packetOf(message);
  Sink sink;
  Traffic traffic;
  for (auto _ : state) receivePacket(sink, TaskId{1}, packet, traffic);
  report(state, message, packet.size());
}

// A whole intersection at a shade task: told of it, its colours come, it is shaded and answered.
void shade(benchmark::State& state, std::size_t pending, bool reflected) {
  NullLink link;
  ShadeTask task(link);
  Traffic traffic;
  Configure configure;
  configure.epoch = Epoch{1};
  for (int i = 0; i < 3; ++i)
    configure.settings.lights.push_back({PointLight{{4.0 + i, 3, 2}}, kWhite, true});
  configure.directory.voxelTasks = {TaskId{1}};
  configure.directory.machines = {0};
  configure.directory.shadeTasks = {TaskId{2}};
  task.on(TaskId{1}, configure);
  std::uint64_t number = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kMessages; ++i)
      task.on(TaskId{1}, expectation(recordOf(0, number + i), pending, reflected));
    for (std::size_t i = 0; i < kMessages; ++i) {
      LightAnswers answers{recordOf(0, number + i), {}};
      for (std::size_t slot = 0; slot < pending; ++slot)
        answers.colors.push_back({static_cast<Slot>(slot), kWhite});
      if (pending > 0) task.on(TaskId{1}, answers);
      if (reflected) task.on(TaskId{1}, Answer{recordOf(0, number + i), kReflectedSlot, kWhite});
    }
    if (pending > 0 || reflected) number += kMessages;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kMessages));
}

// Light that changes from pixel to pixel, with edges here and there.
Color lightAt(const SampleId& id) {
  const double v = (id.x / 50 + id.y / 70) % 2 * 0.5 + 1e-5 * id.x;
  return {v, v / 2, v / 3};
}

// The host's part of a picture, for each sample: tiles go out, their colours come in, what is refined is decided, rows are taken.
struct Host {
  using Accepted = TypeList<TileDone>;
  Epoch epoch() const { return Epoch{1}; }
  void on(TaskId, const TileDone& message) { sampler.supply(tiles[message.number], message.colors); }
  Sampler sampler;
  std::vector<Tile> tiles;
};

void takePicture(benchmark::State& state, std::int32_t samplesPerSide) {
  PictureSpec picture;
  picture.width = picture.height = 512;
  picture.samplesPerSide = samplesPerSide;
  // What tasks would answer.
  std::vector<Bytes> answers;
  std::uint64_t samples = 0;
  {
    KeepingLink link;
    Outbox outbox(link);
    outbox.beginEpoch(Epoch{1});
    Sampler sampler(picture, 1, 0);
    std::vector<Color> row;
    while (!sampler.finished()) {
      while (const std::optional<Tile> tile = sampler.nextTile()) {
        TileSampler traced(sampler.rules(), *tile);
        SampleId ids[256];
        while (const std::size_t count = traced.next(ids)) {
          for (std::size_t i = 0; i < count; ++i) traced.supply(ids[i], lightAt(ids[i]));
        }
        outbox.post(TaskId{1}, TileDone{static_cast<std::uint32_t>(answers.size()), traced.colors()});
        outbox.flush();
        answers.push_back(std::move(link.sent.back()));
        samples += traced.colors().samples;
        sampler.supply(*tile, traced.colors());
      }
      SampleId missing;
      while (sampler.nextSamples(std::span(&missing, 1)) > 0) sampler.supply(missing, lightAt(missing));
      while (sampler.takeRow(row)) {
      }
    }
  }
  NullLink link;
  Outbox outbox(link);
  Traffic traffic;
  std::vector<Color> row;
  for (auto _ : state) {
    Host host{Sampler(picture, 1, 0), {}};
    while (!host.sampler.finished()) {
      while (const std::optional<Tile> tile = host.sampler.nextTile()) {
        const auto number = static_cast<std::uint32_t>(host.tiles.size());
        outbox.post(TaskId{2}, TileWork{number, *tile});
        host.tiles.push_back(*tile);
        receivePacket(host, TaskId{2}, answers[number], traffic);
      }
      SampleId missing;
      while (host.sampler.nextSamples(std::span(&missing, 1)) > 0)
        host.sampler.supply(missing, lightAt(missing));
      while (host.sampler.takeRow(row)) benchmark::DoNotOptimize(row.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
}

template <class M>
void both(const std::string& name, const M& message) {
  benchmark::RegisterBenchmark(("write " + name).c_str(), [=](benchmark::State& s) { write(s, message); });
  benchmark::RegisterBenchmark(("read " + name).c_str(), [=](benchmark::State& s) { read(s, message); });
}

}  // namespace
}  // namespace rayshade

int main(int argc, char** argv) {
  using namespace rayshade;
  both("ray", rayTask());
  both("two shadow rays", shadowTask());
  both("answer", Answer{12345, kReflectedSlot, {.1, .2, .3}});
  both("answer of a light", LightAnswers{});
  both("intersection, complete", expectation(1, 0, false));
  both("intersection, one light pending", expectation(1, 1, false));
  benchmark::RegisterBenchmark("shade, complete", [](benchmark::State& s) { shade(s, 0, false); });
  benchmark::RegisterBenchmark("shade, one light pending", [](benchmark::State& s) { shade(s, 1, false); });
  benchmark::RegisterBenchmark("shade, light and reflection pending",
                               [](benchmark::State& s) { shade(s, 1, true); });
  benchmark::RegisterBenchmark("host, a picture of one sample a pixel",
                               [](benchmark::State& s) { takePicture(s, 1); });
  benchmark::RegisterBenchmark("host, a picture of up to nine",
                               [](benchmark::State& s) { takePicture(s, 3); });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
