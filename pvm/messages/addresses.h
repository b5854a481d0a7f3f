// Who is who: epochs, records and slots, the self-addressed envelope of a ray, the directory of tasks.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/link/link.h"
#include "rayshade/space/bintree.h"

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
  std::vector<std::uint32_t>
      machines;  // where each task that traces stands, voxel tasks first: a number for each machine
  std::vector<TaskId> shadeTasks;
  std::vector<std::uint32_t> shadeWeights;  // in what proportion they are chosen

  std::uint32_t tasksPerCluster() const { return static_cast<std::uint32_t>(voxelTasks.size()) / clusters; }
  TaskId ownerOf(VoxelId voxel, std::uint32_t cluster) const {
    return voxelTasks[cluster * tasksPerCluster() + voxels[static_cast<std::size_t>(voxel)]];
  }
};
// The tasks that trace, which number the intersections that they find: voxel tasks come first.
inline std::size_t finderCount(const Directory& d) { return d.voxelTasks.size() + d.pyramidTasks.size(); }
bool isTracer(const Directory& directory, TaskId task);
// How many tasks trace on the machine of one of them, itself included; `finder`: its place among all that trace.
std::uint32_t tracersBeside(const Directory& directory, std::size_t finder);
// Does it fit together, and has every voxel of the tree an owner?
bool isComplete(const Directory& directory, const BinTree& tree);
// The place of a task among those of its role; nothing: it is not one of them.
std::optional<std::uint32_t> placeAmong(const std::vector<TaskId>& tasks, TaskId task);
// Which shade task gets an intersection, the `serial`-th that a task finds: any choice gives the same picture.  Requires
// that there are any.
std::size_t chooseShadeTask(const Directory& directory, std::uint64_t serial);

template <class Archive>
void serialize(Archive& archive, ReplyTo& r) {
  archive(r.task, r.record, r.slot);
}

template <class Archive>
void serialize(Archive& archive, Directory& d) {
  archive(d.voxelTasks, d.clusters, d.voxels, d.pyramidTasks, d.machines, d.shadeTasks, d.shadeWeights);
}

}  // namespace rayshade
