// The Standard Procedural Databases, written anew: scenes of any size on which ray tracers have been compared
// since 1987.
//
// Source: Haines, A Proposal for Standard Graphics Environments, IEEE CG&A 7(11), 1987.  Each scene has one
// number for its size; what it means is said in the scene's own file.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scenes/spd/scene_writer.h"

namespace rayshade::spd {

// The scenes; `size` within 1 ... largestSize of the table below.
void writeBalls(int size, SceneWriter& out);
void writeGears(int size, SceneWriter& out);
void writeLattice(int size, SceneWriter& out);
void writeMount(int size, SceneWriter& out);
void writeRings(int size, SceneWriter& out);
void writeShells(int size, SceneWriter& out);
void writeTeapot(int size, SceneWriter& out);
void writeTetra(int size, SceneWriter& out);
void writeTree(int size, SceneWriter& out);

struct SceneKind {
  std::string_view name;
  int usualSize, largestSize;
  void (*write)(int size, SceneWriter& out);
};

std::span<const SceneKind> sceneKinds();
const SceneKind* findScene(std::string_view name);  // null: no such scene

struct SceneRequest {
  std::string_view name;
  int size = 0;  // 0: the usual size
};

// False, and nothing written, when there is no such scene or size.
bool writeScene(const SceneRequest& request, SceneWriter& out);

// The light of a scene with `count` lights has this intensity each, so that more lights are not much brighter.
double lightIntensity(int count);

// 4, 9, ... : base^exponent in integers; the sizes above keep it below 2^64.
std::uint64_t power(std::uint64_t base, int exponent);

}  // namespace rayshade::spd
