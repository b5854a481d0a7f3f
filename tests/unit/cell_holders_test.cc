// SPDX-License-Identifier: BSD-3-Clause
#include "pvm/trace/cell_holders.h"

#include <gtest/gtest.h>

namespace rayshade {
namespace {

constexpr TaskId kOwner{1}, kFar{2}, kFarToo{3}, kPyramid{4}, kNear{5};

// The owner and one more on machine 0, the others on machine 1.
CellHolders ownerOfMany() {
  Directory directory;
  directory.voxelTasks = {kOwner, kFar};
  directory.pyramidTasks = {kFarToo, kPyramid, kNear};
  directory.machines = {0, 1, 1, 1, 0};
  CellHolders holders;
  holders.begin(directory, kOwner);
  return holders;
}

TEST(CellHolders, TheFirstGetsACellFromItsOwnerAndTheNextFromTheirOwnMachine) {
  CellHolders holders = ownerOfMany();
  EXPECT_EQ(holders.choose(CellId{7}, kFar), kOwner);
  EXPECT_EQ(holders.choose(CellId{7}, kFarToo), kFar);
  EXPECT_EQ(holders.choose(CellId{7}, kPyramid), kFarToo) << "it has given less";
  EXPECT_EQ(holders.choose(CellId{7}, kNear), kOwner) << "it stands beside the owner";
  EXPECT_EQ(holders.choose(CellId{8}, kPyramid), kOwner) << "another cell";
}

TEST(CellHolders, WhoHasLostACellIsNotAskedForItAgain) {
  CellHolders holders = ownerOfMany();
  holders.choose(CellId{7}, kFar);
  holders.forget(CellId{7}, kFar);
  holders.forget(CellId{9}, kFar);
  EXPECT_EQ(holders.choose(CellId{7}, kFarToo), kOwner);
}

TEST(CellHolders, NobodyIsSentToItself) {
  CellHolders holders = ownerOfMany();
  EXPECT_EQ(holders.choose(CellId{7}, kFar), kOwner);
  EXPECT_EQ(holders.choose(CellId{7}, kFar), kOwner) << "it has thrown the cell out";
}

TEST(CellHolders, OnlyTasksThatTraceGetCells) {
  CellHolders holders = ownerOfMany();
  EXPECT_EQ(holders.choose(CellId{7}, TaskId{99}), kNobody);
}

}  // namespace
}  // namespace rayshade
