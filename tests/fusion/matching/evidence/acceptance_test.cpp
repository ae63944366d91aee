// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/acceptance.hpp"

#include <gtest/gtest.h>

namespace cairn::matching {
namespace {

Evidence convincing() {
  Evidence e;
  e.structure_inliers = 0.8;
  e.agreeing_m2 = 300;
  e.agreeing_floor_m2 = 200;
  e.weakest_translation = 0.2;
  return e;
}

TEST(Decide, NeedsEverySettingMet) {
  const Decision decision = decide(convincing());
  ASSERT_TRUE(decision.accepted) << decision.reason;
  EXPECT_FALSE(decide(convincing(), {.least_probability = decision.probability_correct + 1e-6}).accepted);
  EXPECT_FALSE(decide(convincing(), {.least_agreeing_m2 = 301}).accepted);
  EXPECT_FALSE(decide(convincing(), {.least_structure_inliers = 0.81}).accepted);
  EXPECT_FALSE(decide(convincing(), {.least_weakest_translation = 0.21}).accepted);
  EXPECT_FALSE(decide(convincing(), {.least_floor_m2 = 201}).accepted);
}

TEST(Decide, LackOfStructureOrOfADirectionIsRightWithAFewPercentAtMost) {
  EXPECT_LE(decide(convincing(), {.least_agreeing_m2 = 301}).probability_correct, 0.05);
  EXPECT_LE(decide(convincing(), {.hardly_structure_inliers = 0.81}).probability_correct, 0.05);
  EXPECT_LE(decide(convincing(), {.least_weakest_translation = 0.21}).probability_correct, 0.05);
}

TEST(Decide, SurfacesThatMostlyDifferDoNotDecideButCount) {
  Evidence rough = convincing();
  rough.structure_inliers = 0.3;  // a street, or a stereo camera's map
  EXPECT_FALSE(decide(rough).accepted);
  EXPECT_EQ(decide(rough).probability_correct, decide(convincing()).probability_correct);
  rough.structure_inliers = 0.24;
  EXPECT_LE(decide(rough).probability_correct, 0.05);
}

TEST(Decide, OneFurnishedRoomIsNotEnoughHoweverWellItFits) {
  Evidence room = convincing();
  room.structure_inliers = 0.95;
  room.agreeing_m2 = room.agreeing_floor_m2 = 70;
  EXPECT_FALSE(decide(room).accepted);
}

TEST(Decide, AsMuchOfALargeMapCountsAsOfASmallOne) {
  Evidence small = convincing(), large = convincing();
  small.overlap = 0.9;
  small.structure_pairs = 1400;
  large.overlap = 0.05;
  large.structure_pairs = 70;
  EXPECT_TRUE(decide(large).accepted);
  EXPECT_EQ(decide(large).probability_correct, decide(small).probability_correct);
}

TEST(Decide, MovedFurnitureIsNoContradictionButAHalfTurnIs) {
  Evidence changed = convincing(), turned_about = convincing();
  changed.agreeing_floor_m2 = 350;
  changed.conflict = 0.01;  // eight boxes of 1.2 m in a floor of rooms
  changed.reverse_conflict = 0.02;
  EXPECT_TRUE(decide(changed).accepted);
  turned_about.structure_inliers = 0.27;  // a hall, half-turned
  EXPECT_FALSE(decide(turned_about).accepted);
}

TEST(Decide, ARivalThatIsAsGoodLeavesAnEvenChanceHoweverMuchAgrees) {
  Evidence rivalled = convincing();
  rivalled.agreeing_floor_m2 = 1e5;
  rivalled.uniqueness = 0;
  EXPECT_FALSE(decide(rivalled).accepted);
  EXPECT_LE(decide(rivalled).probability_correct, 0.5);
}

TEST(Decide, ConflictAndRivalsMakeItLessProbable) {
  Evidence conflict = convincing(), rivalled = convincing();
  conflict.reverse_conflict = 0.02;
  rivalled.uniqueness = 0.1;
  const double p = decide(convincing()).probability_correct;
  EXPECT_LT(decide(conflict).probability_correct, p);
  EXPECT_LT(decide(rivalled).probability_correct, p);
}

}  // namespace
}  // namespace cairn::matching
