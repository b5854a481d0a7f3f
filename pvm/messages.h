// Every message: its fields, and whether it is a fact or work.
//
// Facts hold in any epoch; work of another epoch than the receiver's is refused.  A packet is
//   version u8 | epoch u32 | message*        message = tag u8 (position in AllMessages), fields
// See docs/wire-format.md.  The tasks and their messages are those of Reinhard & Jansen, figures 2 and 3.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/link.h"
#include "pvm/object_cache.h"
#include "rayshade/base/type_list.h"
#include "rayshade/image/sampler.h"
#include "rayshade/scene/camera.h"
#include "rayshade/scene/items.h"
#include "rayshade/scene/store.h"
#include "rayshade/shading/combine.h"
#include "rayshade/space/bintree.h"
#include "rayshade/trace.h"

namespace rayshade {

enum class Epoch : std::uint32_t {};

// The place where a colour is awaited: a record of a task, and one of its slots.  For the host a record is a sample.
using RecordId = std::uint64_t;
using Slot = std::uint32_t;  // a light point, or one of these:
inline constexpr Slot kTransmittedSlot = 0xfffffffeu;
inline constexpr Slot kReflectedSlot = 0xffffffffu;

// A shade task's records are numbered by whoever found the intersections: `finder` is his number among all tasks that
// trace, `number` counts those of his records at this shade task that wait for something.
inline constexpr int kNumberBits = 44;
constexpr RecordId recordOf(std::uint32_t finder, std::uint64_t number) {
  return static_cast<RecordId>(finder) << kNumberBits | number;
}
constexpr std::uint32_t finderOf(RecordId record) {
  return static_cast<std::uint32_t>(record >> kNumberBits);
}
constexpr std::uint64_t numberOf(RecordId record) { return record & ((RecordId{1} << kNumberBits) - 1); }

// The self-addressed envelope that travels with every ray.
struct ReplyTo {
  TaskId task = kNobody;
  RecordId record = 0;
  Slot slot = 0;
};

// Who is who in an epoch.  With K clusters the model is there K times, distributed within each; rays never leave their
// cluster, only colours do (Reinhard & Jansen, section 6).
struct Directory {
  std::vector<TaskId> voxelTasks;  // one cluster after the other, all of the same size
  std::uint32_t clusters = 1;
  std::vector<std::uint32_t> voxels;  // by voxel: which task of a cluster has it
  std::vector<TaskId> pyramidTasks;   // task i belongs to cluster i modulo `clusters`
  std::vector<TaskId> shadeTasks;
  std::vector<std::uint32_t> shadeWeights;  // in what proportion they are chosen

  std::uint32_t tasksPerCluster() const { return static_cast<std::uint32_t>(voxelTasks.size()) / clusters; }
  TaskId ownerOf(VoxelId voxel, std::uint32_t cluster) const {
    return voxelTasks[cluster * tasksPerCluster() + voxels[static_cast<std::size_t>(voxel)]];
  }
};
// The tasks that trace, which number the intersections that they find: voxel tasks come first.
inline std::size_t finderCount(const Directory& d) { return d.voxelTasks.size() + d.pyramidTasks.size(); }
// Does it fit together, and has every voxel of the tree an owner?
bool isComplete(const Directory& directory, const BinTree& tree);
struct Configure;
bool isComplete(const Configure& message);

// Which shade task gets an intersection, the `serial`-th that a task finds: any choice gives the same picture.  Requires
// that there are any.
std::size_t chooseShadeTask(const Directory& directory, std::uint64_t serial);

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
  bool shadeAtOnce = false;             // what gets all of its colours where it was found is shaded there
  std::uint64_t cacheBytes = 64 << 20;  // of each task
  std::uint32_t outstanding = 64;       // cells asked for at a time
};

// What pyramid tasks need to make rays of samples.
struct Exhibition {
  View view;
  PictureSpec picture;
  std::uint64_t seed = 0;
};

// The primary ray of a sample.
Ray primaryRay(const Exhibition& exhibition, const Exposure& exposure, const SampleId& sample);

// ---- facts

// Forget all items: another frame begins.
struct Forget {
  static constexpr bool isFact = true;
};

// A batch of a task's share of the model.
struct Items {
  static constexpr bool isFact = true;
  std::vector<Item> items;
};

// One batch was taken in: there may be another.
struct ItemsTaken {
  static constexpr bool isFact = true;
};

// A new epoch: drop all work, keep the items, answer Ready.
struct Configure {
  static constexpr bool isFact = true;
  Epoch epoch{};
  Setting setting;
  BinTree tree;
  Directory directory;
  std::uint32_t number = 0;  // of the receiver among the tasks of its role
  Exposure exposure;
  DemandPolicy policy;
  Exhibition exhibition;
  std::vector<std::uint32_t> cellBytes;  // by cell: what its objects take on the wire; 0: there are none
  std::vector<Bounds> cellContents;      // by cell: the box around what is in it, see Contents
  double loadEvery = 0;                  // seconds between two Loads; 0: none
};

struct Ready {
  static constexpr bool isFact = true;
  Epoch epoch{};
  std::uint64_t arithmetic = 0;  // fingerprint: equal on hosts that compute the same bits
  std::uint64_t objects = 0;     // that the task holds
  std::uint64_t owned =
      0;  // of those, the ones whose lowest corner lies in its voxels: they add up to the scene
  std::uint64_t leftOut = 0;  // items that did not fit together
};

// How busy a task is, a few times a second, when shading is placed dynamically; and what follows from it.
struct Load {
  static constexpr bool isFact = true;
  double busy = 0;  // share of the time since the last one
};
struct Weights {
  static constexpr bool isFact = true;
  Epoch epoch{};
  std::vector<std::uint32_t> shadeWeights;
};

// The end: answer Report and leave.
struct Finish {
  static constexpr bool isFact = true;
};

struct Report {
  static constexpr bool isFact = true;
  TraceCounts counts;
  std::uint64_t combined = 0;  // intersections shaded
  std::uint64_t messagesIn = 0, messagesOut = 0, packetsIn = 0, packetsOut = 0, bytesIn = 0, bytesOut = 0;
  std::uint64_t refused = 0;     // malformed or unexpected
  std::uint64_t stale = 0;       // work of another epoch
  std::uint64_t peakQueue = 0;   // rays or records waiting
  std::uint64_t modelBytes = 0;  // its share of the scene, with accelerators
  std::uint64_t peakMemory = 0;  // of the process, bytes
  double busySeconds = 0, idleSeconds = 0, cpuSeconds = 0;
  CacheCounts cache;
  CacheCounts shadowCache;          // of those, what shadow rays asked for (look-ups only)
  std::uint64_t pyramids = 0;       // traced
  std::uint64_t pyramidRays = 0;    // primary rays in them
  std::uint64_t forwardedRays = 0;  // of those, the ones that went over to the voxels
  std::uint64_t cellsServed = 0;
};

struct Ping {
  static constexpr bool isFact = true;
};
struct Pong {
  static constexpr bool isFact = true;
};

// ---- work

// Follow this ray from position `step` of its walk.
struct RayTask {
  static constexpr bool isFact = false;
  Ray ray;
  std::uint32_t step = 0;
  ReplyTo to;
};

// How far a shadow ray has come on its way to a light point.
struct ShadowTravel {
  Slot slot = 0;  // the light point
  std::uint32_t step = 0;
  Vec3 origin, direction;
  double distance = 0;     // of the light
  Color through = kWhite;  // what has been let through so far; the rest as in ShadowRay
  double last = 0, insideExtinct = 1;
  bool inside = false;
};

// What shadow rays of one intersection have in common.
struct ShadowHead {
  TaskId shader = kNobody;  // who waits for their colours, in this record
  RecordId record = 0;
  Moment moment;
  std::int32_t sample = 0;
  RandomKey key{};
};
// Follow these shadow rays of one intersection.
struct ShadowTask {
  static constexpr bool isFact = false;
  ShadowHead head;
  InlineVector<ShadowTravel, 4> rays;  // at least one
};
ShadowTravel travelOf(const ShadowRay& shadow, Slot slot, std::uint32_t step);
ShadowRay shadowOf(const ShadowHead& head, const ShadowTravel& travel);

// Light that arrives at an intersection.
struct LightAnswer {
  Slot slot = 0;
  Color color;
};
struct LightAnswers {
  static constexpr bool isFact = false;
  RecordId record = 0;
  InlineVector<LightAnswer, 8> colors;
};

// To a shade task: an intersection whose colours will come, or have come, to `record`; its own colour goes to `to`.
// Colours that were known at once travel with it.
struct Expect {
  static constexpr bool isFact = false;
  RecordId record = 0;
  ReplyTo to;
  Intersection hit;
  Gathered gathered;              // black where a colour is still to come
  InlineVector<Slot, 8> pending;  // light points whose colour will come in LightAnswers, ascending
};

// From a pyramid task: it could do with a pyramid.
struct PyramidWanted {
  static constexpr bool isFact = false;
};

// Follow the primary rays of these samples: to a pyramid task, the samples of a tile, which make one pyramid; to a
// voxel-trace task, samples whose rays as a rule begin in its voxels.  Sample i is record firstRecord + i of the host.
struct PrimaryRays {
  static constexpr bool isFact = false;
  RecordId firstRecord = 0;
  std::vector<SampleId> samples;
};

// Are there any, and are they samples of this picture?
bool samplesFit(const PrimaryRays& message, const PictureSpec& picture);

// From a task that traces with fetched cells, to the owner of the cell's voxel; and back.
struct CellWanted {
  static constexpr bool isFact = false;
  CellId cell{};
};
struct CellItems {
  static constexpr bool isFact = false;
  CellId cell{};
  std::vector<Item> items;
};

// A colour comes home.
struct Answer {
  static constexpr bool isFact = false;
  RecordId record = 0;
  Slot slot = 0;
  Color color;
};

// The same for samples, to the host: the colour of record first + i for each i.
struct SampleColors {
  static constexpr bool isFact = false;
  RecordId first = 0;
  std::vector<Color> colors;
};

// Append only: the position is the tag.
using AllMessages = TypeList<Forget, Items, ItemsTaken, Configure, Ready, Finish, Report, Ping, Pong, RayTask,
                             ShadowTask, Expect, Answer, PyramidWanted, PrimaryRays, CellWanted, CellItems,
                             Load, Weights, LightAnswers, SampleColors>;

inline constexpr std::uint8_t kWireVersion = 4;

// Does this machine compute the same bits as another?  A hash over results of the library functions that the pictures
// depend on: their last bits differ between processors on which glibc chooses different code.
std::uint64_t arithmeticFingerprint();

template <class Archive>
void serialize(Archive& archive, ReplyTo& r) {
  archive(r.task, r.record, r.slot);
}
template <class Archive>
void serialize(Archive& archive, Directory& d) {
  archive(d.voxelTasks, d.clusters, d.voxels, d.pyramidTasks, d.shadeTasks, d.shadeWeights);
}
template <class Archive>
void serialize(Archive& archive, Horizon& h) {
  archive(h.kind, h.value);
}
template <class Archive>
void serialize(Archive& archive, DemandPolicy& p) {
  archive(p.shadows, p.horizon, p.secondariesTravel, p.shadeAtOnce, p.cacheBytes, p.outstanding);
}
template <class Archive>
void serialize(Archive& archive, Exhibition& e) {
  archive(e.view, e.picture, e.seed);
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
  archive(m.epoch, m.setting, m.tree, m.directory, m.number, m.exposure, m.policy, m.exhibition, m.cellBytes,
          m.cellContents, m.loadEvery);
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
          m.cpuSeconds, m.cache, m.shadowCache, m.pyramids, m.pyramidRays, m.forwardedRays, m.cellsServed);
}
template <class Archive>
void serialize(Archive&, Ping&) {}
template <class Archive>
void serialize(Archive&, Pong&) {}
template <class Archive>
void serialize(Archive& archive, RayTask& m) {
  archive(m.ray, m.step, m.to);
}
// A list whose elements are `leastBytes` at least on the wire.
template <class Archive, class List, class Element>
void serializeEach(Archive& archive, List& list, std::size_t leastBytes, Element element) {
  auto size = static_cast<std::uint32_t>(list.size());
  archive(size);
  if constexpr (Archive::kReading) {
    list.clear();
    if (size > archive.left() / leastBytes) return archive.fail();
    for (std::uint32_t i = 0; i < size && archive.ok(); ++i) {
      element(list.emplace_back());
    }
  } else {
    for (auto& value : list) element(value);
  }
}
template <class Archive>
void serialize(Archive& archive, ShadowTask& m) {
  // As a rule all start at the same place.
  Vec3 origin = m.rays.empty() ? Vec3{} : m.rays[0].origin;
  ShadowHead& head = m.head;
  archive(head.shader, head.record, head.key, origin);
  serializeSparse(archive, Usual{head.moment.time, 0.0}, Usual{head.moment.frame, 0}, Usual{head.sample, 0});
  serializeEach(archive, m.rays, 34, [&](ShadowTravel& r) {
    archive(r.slot, r.step, r.direction);
    serializeSparse(archive, Usual{r.origin, origin}, Usual{r.distance, kInfinity}, Usual{r.through, kWhite},
                    Usual{r.last, 0.0}, Usual{r.insideExtinct, 1.0}, Usual{r.inside, false});
  });
}
template <class Archive>
void serialize(Archive& archive, LightAnswers& m) {
  archive(m.record);
  serializeEach(archive, m.colors, 5, [&](LightAnswer& answer) {
    archive(answer.slot);
    serializeCompact(archive, answer.color);
  });
}
template <class Archive>
void serialize(Archive& archive, Expect& m) {
  archive(m.record, m.to, m.hit, m.pending);
  if constexpr (Archive::kReading) m.gathered.light.resize(m.hit.lit.size());
  std::size_t pending = 0;
  for (std::size_t point = 0; point < m.hit.lit.size(); ++point) {
    if (m.hit.lit[point] != Lit::asked) continue;
    if (pending < m.pending.size() && m.pending[pending] == point) {
      ++pending;
    } else {
      serializeCompact(archive, m.gathered.light[point]);
    }
  }
  // Each pending point is one that was asked for, in order.
  if constexpr (Archive::kReading)
    if (pending != m.pending.size()) archive.fail();
}
template <class Archive>
void serialize(Archive&, PyramidWanted&) {}
// Samples are given row by row of small blocks: most are the right neighbour of the one before.
template <class Archive>
void serialize(Archive& archive, PrimaryRays& m) {
  archive(m.firstRecord);
  SampleId expected{0, 0, 0};
  serializeEach(archive, m.samples, 1, [&](SampleId& sample) {
    bool neighbour = false;
    if constexpr (!Archive::kReading) neighbour = sample == expected;
    archive(neighbour);
    if (neighbour) {
      sample = expected;
    } else {
      archive(sample);
    }
    expected = sample;
    if (expected.x < std::numeric_limits<std::int32_t>::max()) ++expected.x;
  });
}
template <class Archive>
void serialize(Archive& archive, CellWanted& m) {
  archive(m.cell);
}
template <class Archive>
void serialize(Archive& archive, CellItems& m) {
  archive(m.cell, m.items);
}
template <class Archive>
void serialize(Archive& archive, Load& m) {
  archive(m.busy);
}
template <class Archive>
void serialize(Archive& archive, Weights& m) {
  archive(m.epoch, m.shadeWeights);
}
// Where nothing is there is the background, over and over.
template <class Archive>
void serialize(Archive& archive, SampleColors& m) {
  archive(m.first);
  Color before = kBlack;
  serializeEach(archive, m.colors, 1, [&](Color& color) {
    bool again = false;
    if constexpr (!Archive::kReading) again = sameBits(color, before);
    archive(again);
    if (again) {
      color = before;
    } else {
      archive(color);
    }
    before = color;
  });
}
template <class Archive>
void serialize(Archive& archive, Answer& m) {
  archive(m.record, m.slot);
  serializeCompact(archive, m.color);
}

}  // namespace rayshade
