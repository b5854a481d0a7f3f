// --plan says what would happen; --table says what has happened.
// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/schedule/plan.h"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "pvm/program/task_table.h"
#include "pvm/schedule/division.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_text.h"

namespace rayshade {
namespace {

bool isHere(const std::string& name) { return name == "here" || name == "localhost"; }

std::vector<HostInfo> joined(const std::string& hostFile, std::vector<HostInfo> running = {}) {
  std::istringstream in(hostFile);
  return hostsAfterJoining(std::move(running), readHostFile(in, "hosts"), isHere, "here");
}
std::string text(const std::vector<HostInfo>& hosts) {
  std::string all;
  for (const HostInfo& h : hosts) all += h.name + ":" + std::to_string(h.speed) + " ";
  return all;
}

TEST(Plan, TheOwnMachineIsTheFirstHostWhereverTheFileNamesIt) {
  EXPECT_EQ(text(joined("")), "here:1000 ");
  EXPECT_EQ(text(joined("node1\nlocalhost\nnode2\n")), "localhost:1000 node1:1000 node2:1000 ");
  EXPECT_EQ(text(joined("node1\n")), "here:1000 node1:1000 ");
}

TEST(Plan, SpeedsComeFromTheHostFile) {
  EXPECT_EQ(text(joined("* ep=/x sp=500\nhere sp=2000\nnode1\nnode2 sp=3000 wd=/tmp\n")),
            "here:2000 node1:500 node2:3000 ");
}

TEST(Plan, HostsOfARunningMachineStayAndOthersJoin) {
  EXPECT_EQ(text(joined("here sp=7\nnode1 sp=7\nnode2 sp=7\n", {{"own", 10}, {"node1", 20}})),
            "own:10 node1:20 node2:7 ");
}

struct Surveyed {
  Survey survey;
  SceneHead head;
  FrameRequest request() const { return {viewOf(head.camera, head.picture).value(), head.picture}; }
};
Surveyed surveyOf(const std::string& scene) {
  SurveySink sink({});
  const SceneHead head = jobOfText(scene).read(sink);
  return {sink.survey(), head};
}
std::string planOf(const std::string& scene, const std::vector<HostInfo>& hosts, const HostOptions& options) {
  const Surveyed s = surveyOf(scene);
  FeatureSink features;
  jobOfText(scene).read(features);
  const SceneWork work = sceneWork(scenePlan(features.features(), s.head), s.survey.objects);
  return describePlan(hosts, options, s.survey, s.request(), s.head.settings, work);
}
std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

TEST(Plan, NamesEveryTaskWithTheHostAndReasonOfTheMapping) {
  const std::vector<HostInfo> hosts{{"here", 1000}, {"fast", 3000}, {"slow", 500}};
  HostOptions options;
  options.wishes = {.voxels = 7, .pyramids = 2, .shades = 2, .clusters = 1};
  const std::vector<std::string> plan = lines(planOf(randomScene(1), hosts, options));
  const std::vector<Placement> placements = mapProcesses(hosts, options.wishes);
  const auto begin = std::find_if(plan.begin(), plan.end(),
                                  [](const std::string& line) { return line.starts_with("host 0 "); });
  ASSERT_GT(plan.end() - begin, static_cast<std::ptrdiff_t>(placements.size()));
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const Placement& p = placements[i];
    const std::string& line = *(begin + 1 + static_cast<std::ptrdiff_t>(i));
    EXPECT_TRUE(
        line.starts_with(std::string(programName(p.role)).substr(9) + " " + std::to_string(p.index) + " "))
        << line;
    EXPECT_NE(line.find(" " + p.host + " "), std::string::npos) << line;
    EXPECT_TRUE(line.ends_with(p.reason)) << line;
  }
}

TEST(Plan, SaysHowManyObjectsEachVoxelTaskIsExpectedToHold) {
  HostOptions options;
  options.wishes.voxels = 2;
  const std::string plan =
      planOf("sphere diffuse 1 1 1 1 -5 0 0 sphere diffuse 1 1 1 1 -6 0 0 sphere diffuse 1 1 1 1 6 0 0",
             {{"here", 1000}}, options);
  EXPECT_NE(plan.find(" ~2 "), std::string::npos) << plan;
  EXPECT_NE(plan.find(" ~1 "), std::string::npos) << plan;
}

TEST(Plan, SaysWhatTheSceneAndTheScheduleDoWithoutTasks) {
  const std::string sphere = "sphere diffuse 1 1 1 1 0 0 0 ";
  HostOptions data;
  data.wishes.voxels = 2;
  auto plan = [&](const std::string& scene, const HostOptions& o) {
    return planOf(scene, {{"here", 1000}}, o);
  };
  EXPECT_NE(plan(sphere, data).find("no pyramid tasks"), std::string::npos);
  EXPECT_EQ(plan(sphere, data).find("pyramid-trace"), std::string::npos);
  HostOptions hybrid = data;
  hybrid.wishes.pyramids = 1;
  EXPECT_EQ(plan(sphere, hybrid).find("no pyramid tasks"), std::string::npos);
  EXPECT_NE(plan("light 1 point 0 0 9 noshadow " + sphere, data).find("no light casts shadows"),
            std::string::npos);
  EXPECT_NE(plan("light 1 area 0 0 9 1 0 9 2 0 1 9 2 light 1 point 0 0 9 " + sphere, data)
                .find("to 2 lights, 1 of them areas"),
            std::string::npos)
      << plan("light 1 area 0 0 9 1 0 9 2 0 1 9 2 light 1 point 0 0 9 " + sphere, data);
}

TEST(Division, EveryVoxelHasAnOwnerEvenWhenMoreAreWishedThanTreesMayHave) {
  Surveyed scene = surveyOf(randomScene(2));
  HostOptions options;
  options.voxelsPerTask = 64;
  for (std::uint32_t tasks : {1u, 3u, 4096u}) {
    const Division division = divideSpace(scene.survey, scene.request(), scene.head.settings, options,
                                          std::vector<TaskPlace>(tasks));
    ASSERT_EQ(division.owners.size(), voxelCount(division.tree));
    EXPECT_EQ(*std::max_element(division.owners.begin(), division.owners.end()), tasks - 1);
  }
}

TEST(Division, VoxelsOfEqualCostAreSmallWhereTheEyeLooks) {
  std::string scene = "screen 64 64 eyep 10 0 50 lookp 10 0 0 up 0 1 0 fov 10 ";
  for (int i = 0; i < 400; ++i)
    scene += "sphere diffuse 1 1 1 .4 " + std::to_string(i % 20) + " " + std::to_string(i / 20 - 10) + " 0 ";
  Surveyed s = surveyOf(scene);
  HostOptions options;
  options.split = Split::cost;
  const Division division =
      divideSpace(s.survey, s.request(), s.head.settings, options, std::vector<TaskPlace>(8));
  std::vector<VoxelId> seen;  // the eye sees x from 5.6 to 14.4
  voxelsTouching(division.tree, {{6, -4, -1}, {14, 4, 1}}, seen);
  EXPECT_GE(seen.size(), 6u);
  options.split = Split::equal;
  seen.clear();
  voxelsTouching(
      divideSpace(s.survey, s.request(), s.head.settings, options, std::vector<TaskPlace>(16)).tree,
      {{8, -2, -1}, {9, -1, 1}}, seen);
  EXPECT_LE(seen.size(), 4u);
}

// A row of small spheres, which can be divided anywhere.
std::string rowOfSpheres(int count) {
  std::string scene = "screen 64 64 eyep 0 -50 0 ";
  for (int i = 0; i < count; ++i) scene += "sphere diffuse 1 1 1 .4 " + std::to_string(i) + " 0 0 ";
  return scene;
}
Division divided(Surveyed& s, const std::vector<TaskPlace>& places) {
  return divideSpace(s.survey, s.request(), s.head.settings, {}, places);
}

TEST(Division, SmallHostsGetLessAndTheOthersTheRest) {
  Surveyed s = surveyOf(rowOfSpheres(4000));
  const auto bytes = static_cast<double>(s.survey.bytes);
  std::vector<TaskPlace> places(4);
  places[2] = {"small", 1, s.survey.bytes / 20};
  const Division division = divided(s, places);
  EXPECT_LE(division.expected[2].bytes, 1.05 * bytes / 20);
  EXPECT_GE(division.expected[2].bytes, 0.1 * bytes / 20);
  for (const int other : {0, 1, 3}) EXPECT_NEAR(division.expected[other].bytes, bytes * 19 / 60, 0.1 * bytes);
  EXPECT_EQ(whatDoesNotFit(division, places), "");
}

TEST(Division, MemoryThatSufficesChangesNothing) {
  Surveyed s = surveyOf(rowOfSpheres(1000));
  std::vector<TaskPlace> unknown(3), ample(3);
  for (TaskPlace& place : ample) place.room = 1 << 30;
  EXPECT_EQ(encode(divided(s, unknown).tree), encode(divided(s, ample).tree));
}

TEST(Division, WhatCannotFitIsSaidWithWhatWouldBeNeeded) {
  Surveyed s = surveyOf(rowOfSpheres(300'000));  // about 40 MB
  ASSERT_GT(s.survey.bytes, 30'000'000u);
  std::vector<TaskPlace> places(2, {"tiny", 1, 1'000'000});
  const std::string problem = whatDoesNotFit(divided(s, places), places);
  EXPECT_TRUE(problem.starts_with("not enough memory for the scene: its objects take about ")) << problem;
  EXPECT_NE(problem.find(" on tiny would hold "), std::string::npos) << problem;
  EXPECT_NE(problem.find(" more memory is needed"), std::string::npos) << problem;
  EXPECT_EQ(whatDoesNotFit(divided(s, std::vector<TaskPlace>(2)), std::vector<TaskPlace>(2)), "");
}

TEST(Division, RoomsComeFromTheMemoryOfHosts) {
  const std::vector<HostInfo> hosts{{"own", 1000}, {"big", 2000}, {"unknown", 500}};
  Wishes wishes{.voxels = 6, .shades = 0};
  wishes.memory = {{"own", {500'000'000, 0}}, {"big", {4'000'000'000, 100'000'000}}};
  const std::vector<Placement> placements = mapProcesses(hosts, wishes);
  const std::vector<TaskPlace> places = placesOfVoxelTasks(hosts, placements, wishes);
  ASSERT_EQ(places.size(), 6u);
  for (std::size_t task = 0; task < places.size(); ++task) {
    const TaskPlace& place = places[task];
    const auto here = std::ranges::count(placements, placements[task].host, &Placement::host);
    EXPECT_EQ(place.host, placements[task].host);
    const double machine = place.host == "own" ? (500e6 - kHostTaskBytes) / static_cast<double>(here) : 100e6;
    if (place.host == "unknown") {
      EXPECT_EQ(place.room, TaskPlace::kUnknown);
    } else {
      EXPECT_NEAR(static_cast<double>(place.room), machine / kPeak - kTaskBytes, 2);
    }
  }
}

TEST(Plan, SaysWhatStaysWhole) {
  const std::string sphere = "sphere diffuse 1 1 1 1 0 0 0 ";
  const std::string plan =
      planOf("name ball " + sphere + " object ball object ball translate 3 0 0 " + "difference " + sphere +
                 sphere + " end heightfield diffuse 1 1 1 tests/support/hills.hf " + sphere +
                 " texture image tests/data/suite/blob-b.png",
             {{"here", 1000}}, {});
  EXPECT_NE(plan.find("held whole      1 CSG operations of 0.000 MB"), std::string::npos) << plan;
  EXPECT_NE(plan.find(" 1 named objects of "), std::string::npos) << plan;
  EXPECT_NE(plan.find(" 1 height fields of "), std::string::npos) << plan;
  EXPECT_EQ(planOf(sphere, {{"here", 1000}}, {}).find("held whole"), std::string::npos);
}

TEST(Plan, WarnsWhenTheSceneDoesNotFit) {
  HostOptions options;
  options.wishes.voxels = 2;
  options.wishes.memory["here"] = {50'000'000, 0};
  EXPECT_NE(planOf(rowOfSpheres(100'000), {{"here", 1000}}, options).find("\nwarning: not enough memory"),
            std::string::npos);
  options.wishes.memory["here"] = {500'000'000, 0};
  EXPECT_EQ(planOf(rowOfSpheres(100'000), {{"here", 1000}}, options).find("warning"), std::string::npos);
}

// The table as a map from column to values, by the names in its first line.
std::map<std::string, std::vector<std::string>> columnsOf(const std::string& table) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::string>> columns;
  for (const std::string& line : lines(table)) {
    if (line.starts_with("#")) continue;
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, '\t');) fields.push_back(field);
    if (names.empty()) {
      names = fields;
      continue;
    }
    EXPECT_EQ(fields.size(), names.size()) << line;
    for (std::size_t i = 0; i < std::min(fields.size(), names.size()); ++i)
      columns[names[i]].push_back(fields[i]);
  }
  return columns;
}

TEST(TaskTable, HasALineForEveryTaskTheHostFirst) {
  HostOptions options;
  options.wishes = {.voxels = 3, .pyramids = 2, .shades = 1, .clusters = 1};
  const RenderedByTasks done = renderByTasks(jobOfText(randomScene(4)), options, {.seed = 1});
  const std::string table = taskTable(done.summary, 0xabcdef);
  EXPECT_TRUE(table.starts_with("# checksum\t0000000000abcdef\n")) << table;
  auto columns = columnsOf(table);
  EXPECT_EQ(columns["role"], (std::vector<std::string>{"host", "voxel-trace", "voxel-trace", "voxel-trace",
                                                       "pyramid-trace", "pyramid-trace", "shade"}));
  std::uint64_t hits = 0, bytesOut = 0, bytesIn = 0;
  for (const std::string& n : columns["hits"]) hits += std::stoull(n);
  for (const std::string& n : columns["bytesOut"]) bytesOut += std::stoull(n);
  for (const std::string& n : columns["bytesIn"]) bytesIn += std::stoull(n);
  EXPECT_EQ(hits, done.counts.hits);
  EXPECT_GT(hits, 0u);
  // A report cannot count itself; everything else that is sent arrives.
  EXPECT_GE(bytesIn, bytesOut);
  EXPECT_LT(bytesIn, bytesOut + 10'000);
}

}  // namespace
}  // namespace rayshade
