// Work: rays, the colours that they bring, and the intersections that wait for them (Reinhard & Jansen, figures 2 and 3).
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/addresses.h"
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
template <class Archive>
void serialize(Archive& archive, RayTask& m) {
  archive(m.ray, m.step, m.to);
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

template <class Archive>
void serialize(Archive& archive, Answer& m) {
  archive(m.record, m.slot);
  serializeCompact(archive, m.color);
}

using RayMessages = TypeList<RayTask, ShadowTask, LightAnswers, Expect, PyramidWanted, PrimaryRays, Answer,
                             SampleColors, TileWork, TileDone>;

}  // namespace rayshade
