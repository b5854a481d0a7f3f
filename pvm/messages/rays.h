// Work: rays, the colours that they bring, and the intersections that wait for them (Reinhard & Jansen, figures 2 and 3).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/packet_memory.h"
#include "rayshade/base/type_list.h"
#include "rayshade/sampling/sampler.h"
#include "rayshade/shading/combine.h"
#include "rayshade/shading/shadow.h"

namespace rayshade {

// To a voxel-trace task: follow this ray from position `step` of its walk.
struct RayTask {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 9;
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
// To a voxel-trace task: follow these shadow rays of one intersection.
struct ShadowTask {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 10;
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
// To a shade task: light that arrives at one intersection, or that does not.
struct LightAnswers {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 19;
  RecordId record = 0;
  InlineVector<LightAnswer, 8> colors;
};

// To a shade task: an intersection whose colours will come, or have come, to `record`; its own colour goes to `to`.
// Colours that were known at once travel with it.
struct Expect {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 11;
  RecordId record = 0;
  ReplyTo to;
  Intersection hit;
  Gathered gathered;              // black where a colour is still to come
  InlineVector<Slot, 8> pending;  // light points whose colour will come in LightAnswers, ascending
};

// From a tracing task to the host: it has room for a pyramid.
struct PyramidWanted {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 13;
};

// Host to a tracing task: follow the primary rays of these samples.  To a voxel-trace task, samples whose rays as a rule begin in
// its voxels; to a task that traces tiles, those that no tile has traced.  Sample i is record firstRecord + i of the host.
struct PrimaryRays {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 14;
  RecordId firstRecord = 0;
  std::vector<SampleId> samples;
};

// Are there any, and are they samples of this picture?
bool samplesFit(const PrimaryRays& message, const PictureSpec& picture);

// Host to a tracing task: trace the samples of this tile, the `number`-th of the frame.
struct TileWork {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 21;
  std::uint32_t number = 0;
  Tile tile;
};
// The largest tile: records of its samples are numbered, see sampleRecord().
inline constexpr std::int32_t kMostTilePixels = 1 << 16;
// Does the tile lie in this picture?
bool fits(const Tile& tile, const SamplingRules& rules);

// The answer to TileWork: the colours of the tile.
struct TileDone {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 22;
  std::uint32_t number = 0;
  TileColors colors;
};

// To a shade task, the host or a tracing task: the colour of a ray comes home.
struct Answer {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 12;
  RecordId record = 0;
  Slot slot = 0;
  Color color;
};

// To the host: the colours of samples, of record first + i for each i.
struct SampleColors {
  static constexpr bool isFact = false;
  static constexpr std::uint8_t tag = 20;
  RecordId first = 0;
  std::vector<Color> colors;
};

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

// Bits 0 and 1: the form of the record; the others: what is not as in the ray before, or more than a byte.
template <class Archive>
void serialize(Archive& archive, RayTask& m, PacketMemory& before) {
  constexpr std::uint8_t kTask = 4, kSlot = 8, kFarStep = 16, kKind = 32, kMedia = 64, kUnknown = 128;
  Ray& ray = m.ray;
  std::uint8_t differs = 0;
  if constexpr (!Archive::kReading) {
    const bool sameKind = sameBits(ray.contribution, before.contribution) && ray.depth == before.depth &&
                          ray.sample == before.sample && sameBits(ray.moment.time, before.moment.time) &&
                          ray.moment.frame == before.moment.frame && sameBits(ray.extinct, before.extinct);
    differs = static_cast<std::uint8_t>(
        static_cast<int>(formOf(m.to.record, before.to.record + 1)) |
        (m.to.task == before.to.task ? 0 : kTask) | (m.to.slot == before.to.slot ? 0 : kSlot) |
        (m.step < 256 ? 0 : kFarStep) | (sameKind ? 0 : kKind) | (ray.media.empty() ? 0 : kMedia));
  }
  archive(differs, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
          ray.direction.z, ray.key);
  if constexpr (Archive::kReading)
    if (differs & kUnknown) return archive.fail();
  if (differs & kFarStep) {
    archive(m.step);
  } else {
    auto step = static_cast<std::uint8_t>(m.step);
    archive(step);
    m.step = step;
  }
  // One by one: a processor waits when what was written in parts is read as a whole.
  TaskId task = Archive::kReading ? before.to.task : m.to.task;
  Slot slot = Archive::kReading ? before.to.slot : m.to.slot;
  RecordId record = m.to.record;
  if (differs & kTask) archive(task);
  if (differs & kSlot) archive(slot);
  serializeRecord(archive, record, before.to.record + 1, static_cast<RecordForm>(differs & 3));
  if constexpr (Archive::kReading) {
    m.to.task = task;
    m.to.slot = slot;
    m.to.record = record;
  }
  before.to.task = task;
  before.to.slot = slot;
  before.to.record = record;
  if (differs & kKind) {
    serializeSparse(archive, Usual{ray.moment.time, 0.0}, Usual{ray.moment.frame, 0}, Usual{ray.depth, 0},
                    Usual{ray.sample, 0}, Usual{ray.contribution, kWhite}, Usual{ray.extinct, 1.0});
    before.moment = ray.moment;
    before.depth = ray.depth;
    before.sample = ray.sample;
    before.contribution = ray.contribution;
    before.extinct = ray.extinct;
  } else if constexpr (Archive::kReading) {
    ray.moment = before.moment;
    ray.depth = before.depth;
    ray.sample = before.sample;
    ray.contribution = before.contribution;
    ray.extinct = before.extinct;
  }
  if (differs & kMedia) archive(ray.media);
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
  if constexpr (Archive::kReading) m.gathered.light.assign(m.hit.visibility.size());
  std::size_t pending = 0;
  for (std::size_t point = 0; point < m.hit.visibility.size(); ++point) {
    if (m.hit.visibility[point] != LightVisibility::traced) continue;
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

// Where nothing is there is the background, over and over.
template <class Archive>
void serializeColors(Archive& archive, std::vector<Color>& colors) {
  Color before = kBlack;
  serializeEach(archive, colors, 1, [&](Color& color) {
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
void serialize(Archive& archive, SampleColors& m) {
  archive(m.first);
  serializeColors(archive, m.colors);
}

template <class Archive>
void serialize(Archive& archive, TileWork& m) {
  archive(m.number, m.tile.x, m.tile.y, m.tile.width, m.tile.height);
}

template <class Archive>
void serialize(Archive& archive, TileDone& m) {
  archive(m.number, m.colors.full, m.colors.samples, m.colors.notFinite);
  serializeColors(archive, m.colors.first);
  serializeColors(archive, m.colors.whole);
}

// Bits 0 and 1: the form of the record; bit 2: another slot than in the answer before; then the form of the colour.
template <class Archive>
void serialize(Archive& archive, Answer& m, PacketMemory& before) {
  constexpr std::uint8_t kSlot = 4, kBlackColor = 8, kWhiteColor = 16, kColor = 24, kUnknown = 0xe0;
  std::uint8_t differs = 0;
  if constexpr (!Archive::kReading)
    differs = static_cast<std::uint8_t>(static_cast<int>(formOf(m.record, before.answered + 1)) |
                                        (m.slot == before.slot ? 0 : kSlot) |
                                        (sameBits(m.color, before.color) ? 0
                                         : sameBits(m.color, kBlack)     ? kBlackColor
                                         : sameBits(m.color, kWhite)     ? kWhiteColor
                                                                         : kColor));
  archive(differs);
  if constexpr (Archive::kReading) {
    if (differs & kUnknown) return archive.fail();
    m.slot = before.slot;
  }
  if (differs & kSlot) archive(m.slot);
  serializeRecord(archive, m.record, before.answered + 1, static_cast<RecordForm>(differs & 3));
  const int color = differs & kColor;
  if (color == kColor) {
    archive(m.color);
  } else if constexpr (Archive::kReading) {
    m.color = color == kBlackColor ? kBlack : color == kWhiteColor ? kWhite : before.color;
  }
  before.answered = m.record;
  before.slot = m.slot;
  before.color = m.color;
}

// Alone they are the first of a packet.
template <class Archive, class M>
requires(std::is_same_v<M, RayTask> || std::is_same_v<M, Answer>) void serialize(Archive& archive, M& m) {
  PacketMemory nothing;
  serialize(archive, m, nothing);
}

using RayMessages = TypeList<RayTask, ShadowTask, LightAnswers, Expect, PyramidWanted, PrimaryRays, Answer,
                             SampleColors, TileWork, TileDone>;

}  // namespace rayshade
