// Facts: starting, shipping a share of the model, a new epoch, being alive, the end.  They hold in any epoch.
// What the host says, and what is answered (Reinhard & Jansen, figure 2: "initialises a number of slave processes, and then
// determines which slave gets which data").
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/addresses.h"
#include "pvm/messages/cells.h"
#include "rayshade/scene/camera.h"
#include "rayshade/scene/store.h"
#include "rayshade/trace/trace_counts.h"

namespace rayshade {

// How work is shared out between rays that travel and objects that do.
enum class ShadowPolicy : std::uint8_t {
  forward,    // shadow rays travel to the voxels, like all others
  local,      // they are traced where the hit was found, with cells of others fetched into a cache
  automatic,  // per light: whichever is expected to move fewer bytes
};
struct Horizon {
  enum class Kind : std::uint8_t { cells, distance, automatic } kind = Kind::automatic;
  double value = 0;  // cells, or world units from the eye
};
struct DemandPolicy {
  ShadowPolicy shadows = ShadowPolicy::forward;
  Horizon horizon;
  bool secondariesTravel = true;        // false: pyramid tasks trace secondary rays too, with what they fetch
  bool shadeLocally = false;            // what gets all of its colours where it was found is shaded there
  std::uint64_t cacheBytes = 64 << 20;  // of each task
  std::uint32_t outstanding = 64;       // cells asked for at a time
};

// The primary ray of a sample.
Ray primaryRay(const FrameRequest& request, const Exposure& exposure, const SampleId& sample);

// Host to voxel-trace tasks: forget all items, another frame begins.
struct Forget {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 0;
};

// Host to a voxel-trace task: a batch of its share of the model.
struct Items {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 1;
  std::vector<Item> items;
};

// The answer to Items: one batch was taken in, there may be another.
struct ItemsTaken {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 2;
};

// Host to all tasks, the same bytes to each: a new epoch; drop all work, keep the items, answer Ready.
struct Configure {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 3;
  Epoch epoch{};
  SceneSettings settings;
  BinTree tree;
  Directory directory;
  std::uint32_t threads = 1;  // of each tracing task; 0: as many as its machine has cores
  Exposure exposure;
  DemandPolicy policy;
  FrameRequest request;
  std::vector<std::uint32_t> cellBytes;  // by cell: what its objects take on the wire; 0: there are none
  std::vector<Bounds> cellBounds;        // by cell: the box around what is in it, see VoxelBounds
  double loadEvery = 0;                  // seconds between two Loads; 0: none
};

// The answer to Configure: all is built, and the fingerprint of the task's arithmetic.
struct Ready {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 4;
  Epoch epoch{};
  std::uint64_t arithmetic = 0;  // fingerprint: equal on hosts that compute the same bits
  std::uint64_t objects = 0;     // that the task holds
  std::uint64_t owned =
      0;  // of those, the ones whose lowest corner lies in its voxels: they add up to the scene
  std::uint64_t leftOut = 0;  // items that did not fit together
};

// To the host, a few times a second when shading is placed dynamically: how busy a task is.
struct Load {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 17;
  double busy = 0;  // share of the time since the last one
};
// Host to tracing tasks, following from Load: in what proportion shade tasks are chosen.
struct Weights {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 18;
  Epoch epoch{};
  std::vector<std::uint32_t> shadeWeights;
};

// Host to all tasks: the end; answer Report and leave.
struct Finish {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 5;
};

// The answer to Finish: what the task counted.
struct Report {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 6;
  TraceCounts counts;
  std::uint64_t combined = 0;  // intersections shaded
  std::uint64_t messagesIn = 0, messagesOut = 0, packetsIn = 0, packetsOut = 0, bytesIn = 0, bytesOut = 0;
  std::uint64_t refused = 0;     // malformed or unexpected
  std::uint64_t stale = 0;       // work of another epoch
  std::uint64_t peakQueue = 0;   // rays or records waiting
  std::uint64_t modelBytes = 0;  // its share of the scene, with accelerators
  std::uint64_t peakMemory = 0;  // of the process, bytes
  double busySeconds = 0, idleSeconds = 0, cpuSeconds = 0;
  double waitSeconds = 0;  // of the idle ones, those with something in hand
  CacheCounts cache;
  CacheCounts shadowCache;          // of those, what shadow rays asked for (look-ups only)
  std::uint64_t pyramids = 0;       // traced
  std::uint64_t pyramidRays = 0;    // primary rays in them
  std::uint64_t forwardedRays = 0;  // of those, the ones that went over to the voxels
  std::uint64_t cellsServed = 0;
};

// Host to a silent task: are you there?
struct Ping {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 7;
};
// The answer to Ping.
struct Pong {
  static constexpr bool isFact = true;
  static constexpr std::uint8_t tag = 8;
};

bool isComplete(const Configure& message);
// Are primary rays traced in tiles, by tasks that ask for them?  Else they are sent where they begin.
bool inTiles(const Configure& message);

template <class Archive>
void serialize(Archive& archive, Horizon& h) {
  archive(h.kind, h.value);
}

template <class Archive>
void serialize(Archive& archive, DemandPolicy& p) {
  archive(p.shadows, p.horizon, p.secondariesTravel, p.shadeLocally, p.cacheBytes, p.outstanding);
}

template <class Archive>
void serialize(Archive&, Forget&) {}

template <class Archive>
void serialize(Archive& archive, Items& m) {
  archive(m.items);
}

template <class Archive>
void serialize(Archive&, ItemsTaken&) {}

template <class Archive>
void serialize(Archive& archive, Exposure& e) {
  archive(e.opens, e.closes, e.frame);
}

template <class Archive>
void serialize(Archive& archive, Configure& m) {
  archive(m.epoch, m.settings, m.tree, m.directory, m.threads, m.exposure, m.policy, m.request, m.cellBytes,
          m.cellBounds, m.loadEvery);
}

template <class Archive>
void serialize(Archive& archive, Ready& m) {
  archive(m.epoch, m.arithmetic, m.objects, m.owned, m.leftOut);
}

template <class Archive>
void serialize(Archive&, Finish&) {}

template <class Archive>
void serialize(Archive& archive, Report& m) {
  archive(m.counts, m.combined, m.messagesIn, m.messagesOut, m.packetsIn, m.packetsOut, m.bytesIn, m.bytesOut,
          m.refused, m.stale, m.peakQueue, m.modelBytes, m.peakMemory, m.busySeconds, m.idleSeconds,
          m.cpuSeconds, m.waitSeconds, m.cache, m.shadowCache, m.pyramids, m.pyramidRays, m.forwardedRays,
          m.cellsServed);
}

template <class Archive>
void serialize(Archive&, Ping&) {}

template <class Archive>
void serialize(Archive&, Pong&) {}

template <class Archive>
void serialize(Archive& archive, Load& m) {
  archive(m.busy);
}

template <class Archive>
void serialize(Archive& archive, Weights& m) {
  archive(m.epoch, m.shadeWeights);
}

using ControlMessages =
    TypeList<Forget, Items, ItemsTaken, Configure, Ready, Load, Weights, Finish, Report, Ping, Pong>;

}  // namespace rayshade
