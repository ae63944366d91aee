// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/submap_check.hpp"

#include <gtest/gtest.h>

namespace cairn::peers {
namespace {

TEST(SubmapCheck, CountsWallsThatAreSeenAgain) {
  mapping::TileState before, now;
  for (unsigned x = 0; x < 5; ++x)
    for (unsigned z = 2; z < 4; ++z) {
      before.set(x, 0, z, x == 4 ? -1.6F : 2.5F);
      now.set(x, 0, z, 2.5F);
    }
  EXPECT_EQ(seen_again(before, now).stood, 8) << "four columns stand as surely as before";
  EXPECT_EQ(seen_again(before, now).contradicted, 2) << "the fifth is new where it was free";
  now.set(0, 0, 2, -0.4F);  // seen through
  now.set(1, 0, 2, 1.5F);   // nearly
  now.set(2, 0, 2, 3.5F);   // more surely
  EXPECT_EQ(seen_again(before, now).stood, 6);
  EXPECT_EQ(seen_again(before, now).contradicted, 4);
}

TEST(SubmapCheck, FloorsFitEverywhere) {
  mapping::TileState before, now;
  for (unsigned x = 0; x < 8; ++x)
    for (unsigned y = 0; y < 8; ++y) {
      before.set(x, y, 0, 3.5F);
      now.set(x, y, 1, 3.5F);
    }
  EXPECT_EQ(seen_again(before, now).stood + seen_again(before, now).contradicted, 0);
}

TEST(SubmapCheck, AFewTurnedVoxelsAreNoContradiction) {
  SubmapCheck check;
  for (int i = 0; i < 100; ++i) check.judge(false, {.stood = 1000, .contradicted = 100});
  EXPECT_EQ(check.doubt(), Doubt::kNone);
  check.judge(false, {.stood = 10, .contradicted = 50});
  EXPECT_EQ(check.doubt(), Doubt::kNone) << "a door, among walls that stand";
}

TEST(SubmapCheck, WallsThatAreSeenThroughAreAndEndWhenTheyStand) {
  SubmapCheck check;
  for (int i = 0; i < 12; ++i) check.judge(false, {.stood = 1000, .contradicted = 20});
  int batches = 0;
  while (check.doubt() == Doubt::kNone && ++batches < 10) check.judge(false, {.stood = 500, .contradicted = 500});
  EXPECT_EQ(check.doubt(), Doubt::kContradicted);
  EXPECT_LE(batches, 3);
  for (int i = 0; i < 3; ++i) check.judge(false, {.stood = 1000, .contradicted = 20});
  EXPECT_EQ(check.doubt(), Doubt::kContradicted) << "not at once";
  for (int i = 0; i < 20; ++i) check.judge(false, {.stood = 1000, .contradicted = 20});
  EXPECT_EQ(check.doubt(), Doubt::kNone);
}

TEST(SubmapCheck, LostOdometryIsADoubtForAWhileAfterwards) {
  SubmapCheck check;
  check.judge(true, {});
  EXPECT_EQ(check.doubt(), Doubt::kLost);
  for (int i = 1; i < SubmapCheck::kSureBatches; ++i) check.judge(false, {.stood = 100});
  EXPECT_EQ(check.doubt(), Doubt::kLost);
  check.judge(false, {.stood = 100});
  EXPECT_EQ(check.doubt(), Doubt::kNone);
}

TEST(SubmapCheck, AWrongPlaceAfterwardsIsAContradiction) {
  SubmapCheck check;
  for (int i = 0; i < 12; ++i) check.judge(false, {.stood = 1000, .contradicted = 20});
  check.judge(true, {});
  for (int i = 0; i < 4; ++i) check.judge(false, {.stood = 300, .contradicted = 300});
  EXPECT_EQ(check.doubt(), Doubt::kContradicted);
}

TEST(SubmapCheck, AmongTreesWhatIsUsualIsNoContradiction) {
  SubmapCheck check;
  for (int i = 0; i < 200; ++i) check.judge(false, {.stood = 800, .contradicted = 200 + 40 * (i % 3)});
  EXPECT_EQ(check.doubt(), Doubt::kNone);
}

TEST(SubmapCheck, NoDoubtLastsForEver) {
  SubmapCheck check;
  for (int i = 0; i < 60; ++i) check.judge(false, {.stood = 1000, .contradicted = 30});
  for (int i = 0; i < 20; ++i) check.judge(false, {.stood = 800, .contradicted = 200});
  EXPECT_EQ(check.doubt(), Doubt::kContradicted);
  for (int i = 0; i < 200; ++i) check.judge(false, {.stood = 800, .contradicted = 200});
  EXPECT_EQ(check.doubt(), Doubt::kNone);
}

TEST(SubmapCheck, FewVoxelsSayNothing) {
  SubmapCheck check;
  for (int i = 0; i < 100; ++i) check.judge(false, {.stood = 20, .contradicted = 60});
  EXPECT_EQ(check.doubt(), Doubt::kNone);
}

}  // namespace
}  // namespace cairn::peers
