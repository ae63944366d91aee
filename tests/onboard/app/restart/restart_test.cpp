// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/restart.hpp"

#include <gtest/gtest.h>

#include "onboard/app/tasks/saving_task.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

Time at(double seconds) { return Time{from_seconds(seconds)}; }

/// A saved map of epoch 3, of ten seconds into this boot.
class RestartTest : public testing::Test {
 protected:
  RestartTest() {
    state.epoch = 3;
    state.boot = boot_id();
    state.stamp = at(10);
  }
  void save() {
    Generations generations(folder.path(), *monitor);
    ASSERT_TRUE(generations.save(*mapping::random_map<mapping::SemanticOcTree>(1, 20), state));
    ASSERT_TRUE(generations.save_state(state));
    ASSERT_TRUE(generations.save_scans({state.epoch, {odometry::PlacedScan{state.stamp, {}, {{1, 2, 3}}}}}));
  }
  PreviousRun look(double now_s, const Successor& by = {}) {
    Generations generations(folder.path(), *monitor);
    return find_previous_run(generations, RestartProfile{}, by, at(now_s), *monitor);
  }
  [[nodiscard]] std::string said() const {
    return monitor->events().empty() ? std::string() : monitor->events().back().what;
  }

  support::TemporaryFolder folder;
  std::unique_ptr<Monitor> monitor = std::make_unique<Monitor>();
  SavedState state;
};

TEST_F(RestartTest, GoesOnInTheMapOfAMomentAgo) {
  save();
  const PreviousRun previous = look(11);
  ASSERT_TRUE(previous.resumed);
  EXPECT_EQ(previous.epoch, 3U);
  EXPECT_EQ(previous.resumed->scans.size(), 1U);
  EXPECT_EQ(said(), "");
}

TEST_F(RestartTest, AnEmptyFolderIsNoEvent) {
  const PreviousRun previous = look(11);
  EXPECT_FALSE(previous.resumed);
  EXPECT_EQ(previous.epoch, 0U);
  EXPECT_FALSE(previous.state_lost);
  EXPECT_EQ(said(), "");
}

TEST_F(RestartTest, TheStateIsLostOnlyWhenNoSavedMapCanBeRead) {
  save();
  Generations generations(folder.path(), *monitor);
  ASSERT_TRUE(generations.load({}));
  ASSERT_TRUE(generations.save(*mapping::random_map<mapping::SemanticOcTree>(2, 20), state));
  std::filesystem::resize_file(folder / Generations::kMapFiles[0], 20);
  EXPECT_FALSE(look(11).state_lost) << "the other generation is whole";
  std::filesystem::resize_file(folder / Generations::kMapFiles[1], 20);
  const PreviousRun previous = look(11);
  EXPECT_FALSE(previous.resumed);
  EXPECT_TRUE(previous.state_lost);
  EXPECT_NE(said().find("map.b.cairn"), std::string::npos) << said();
}

TEST_F(RestartTest, BeginsAnewAndSaysWhy) {
  save();
  EXPECT_FALSE(look(10 + RestartProfile{}.within_s + 1).resumed);
  EXPECT_NE(said().find("too old"), std::string::npos);
  EXPECT_FALSE(look(9).resumed) << "from the future";
  EXPECT_FALSE(look(11, {.resolution_m = 0.2}).resumed);
  EXPECT_NE(said().find("resolution"), std::string::npos);
  state.boot = "another";
  save();
  const PreviousRun previous = look(11);
  EXPECT_FALSE(previous.resumed);
  EXPECT_EQ(previous.epoch, 3U) << "the next map must not take its number";
  EXPECT_NE(said().find("machine was started"), std::string::npos);
}

visual_odometry::Keyframe some_keyframe(double seconds) {
  visual_odometry::Landmark landmark;
  landmark.p_odom = {seconds, 2, 3};
  landmark.covariance = 0.1 * Eigen::Matrix3d::Identity();
  return {at(seconds), {}, {{1, 2, 3, 4}}, {landmark}};
}

TEST_F(RestartTest, ARobotThatSeesItsWayNeedsKeyframes) {
  save();
  EXPECT_FALSE(look(11, {.sees_its_way = true}).resumed);
  EXPECT_NE(said().find("no keyframes"), std::string::npos) << said();
  ASSERT_TRUE(Generations(folder.path(), *monitor).save_keyframes({state.epoch, {some_keyframe(9)}}));
  const PreviousRun previous = look(11, {.sees_its_way = true});
  ASSERT_TRUE(previous.resumed);
  ASSERT_EQ(previous.resumed->keyframes.size(), 1U);
  EXPECT_EQ(resume(*previous.resumed).keyframes.front().landmarks.front().p_odom.x(), 9);
  const support::TemporaryFolder recording;
  ASSERT_TRUE(keep_with_recording(recording.path(), *previous.resumed, *monitor));
  const auto found = resumed_in_recording(recording.path(), *monitor);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->keyframes.front().descriptors, previous.resumed->keyframes.front().descriptors);
  ASSERT_TRUE(Generations(folder.path(), *monitor).save_keyframes({state.epoch + 1, {some_keyframe(9)}}));
  EXPECT_FALSE(look(11, {.sees_its_way = true}).resumed) << "of another map";
}

TEST_F(RestartTest, AMapWhosePoseIsOfANewerEpochIsNotGoneOnIn) {
  save();
  state.epoch = 4;
  Generations generations(folder.path(), *monitor);
  ASSERT_TRUE(generations.load({}));
  ASSERT_TRUE(generations.save_state(state));
  const PreviousRun previous = look(11);
  EXPECT_FALSE(previous.resumed);
  EXPECT_EQ(previous.epoch, 4U);
}

TEST_F(RestartTest, WhatIsKeptWithARecordingIsFoundThere) {
  save();
  const PreviousRun previous = look(11);
  ASSERT_TRUE(previous.resumed);
  const support::TemporaryFolder recording;
  EXPECT_FALSE(resumed_in_recording(recording.path(), *monitor));
  ASSERT_TRUE(keep_with_recording(recording.path(), *previous.resumed, *monitor));
  const auto found = resumed_in_recording(recording.path(), *monitor);
  ASSERT_TRUE(found);
  EXPECT_EQ(mapping::differing_nodes(*found->map, *previous.resumed->map), 0U);
  EXPECT_EQ(found->map_stamp, previous.resumed->map_stamp);
  EXPECT_EQ(found->state.stamp, previous.resumed->state.stamp);
  EXPECT_EQ(found->scans.front().points_base, previous.resumed->scans.front().points_base);
}

LocatedScan located(int number, std::uint32_t epoch) {
  LocatedScan scan;
  scan.stamp = at(0.1 * number);
  scan.epoch = epoch;
  scan.T_odom_base.mean = SE3::from_xyz_rpy((Vector6() << 0.1 * number, 0, 0, 0, 0, 0).finished());
  scan.points_base = {{1, 2, 3}, {1, 2, 3.001F}, {4, 5, 6}};
  return scan;
}

/// Mapping and saving in turns, without threads.
class SavingTest : public RestartTest {
 protected:
  void drive(int from, int to, std::uint32_t epoch, const mapping::SemanticOcTree& map) {
    for (int i = from; i < to; ++i) {
      copier.mapped(located(i, epoch));
      for (int k = 0; k < 9; ++k) copier.idle(at(0.1 * i + 0.01 * k), map);
      in.pose.publish({at(0.1 * i), located(i, epoch).T_odom_base, Vector6::Zero(), epoch});
      task.save(at(0.1 * i));
    }
  }
  ToSave in;
  Generations generations{folder.path(), *monitor};
  MapCopier copier{{}, 1s, {}, in};
  SavingTask task{generations, in, 5, boot_id(), *monitor};
};

TEST_F(SavingTest, AfterADriveMapPoseAndScansAreThere) {
  const auto map = mapping::random_map<mapping::SemanticOcTree>(2, 500);
  drive(0, 35, 1, *map);
  const PreviousRun previous = look(3.5);
  ASSERT_TRUE(previous.resumed) << said();
  EXPECT_EQ(previous.epoch, 6U);
  EXPECT_EQ(mapping::differing_nodes(*previous.resumed->map, *map), 0U);
  EXPECT_EQ(previous.resumed->state.stamp, at(3.4));
  EXPECT_GE(previous.resumed->map_stamp, at(3.0));
  // The first eight, and then one every 0.4 m; each thinned.
  EXPECT_EQ(previous.resumed->scans.size(), 8U + 5U);
  EXPECT_EQ(previous.resumed->scans.front().points_base.size(), 2U);
}

TEST_F(SavingTest, TheLastKeyframesOfTheEpochAreThere) {
  const auto map = mapping::random_map<mapping::SemanticOcTree>(2, 50);
  drive(0, 15, 1, *map);
  const auto hand_over = [&](int number, std::uint32_t epoch) {
    *in.keyframes.back() = {some_keyframe(0.1 * number), epoch};
    in.keyframes.push();
    task.save(at(1.5));
  };
  hand_over(1, 0);  // of the map before
  for (int i = 2; i < 14; ++i) hand_over(i, 1);
  const PreviousRun previous = look(1.5, {.sees_its_way = true});
  ASSERT_TRUE(previous.resumed) << said();
  ASSERT_EQ(previous.resumed->keyframes.size(), visual_odometry::PlaceMemory::kPlaces);
  EXPECT_EQ(previous.resumed->keyframes.back().stamp, at(1.3));
}

TEST_F(SavingTest, ANewEpochForgetsTheScansAndTheHalfCopyOfTheOld) {
  const auto large = mapping::random_map<mapping::SemanticOcTree>(2, 200'000),
             small = mapping::random_map<mapping::SemanticOcTree>(3, 30);
  copier.mapped(located(0, 1));
  copier.idle(at(0), *large);
  drive(1, 40, 2, *small);
  const PreviousRun previous = look(4);
  ASSERT_TRUE(previous.resumed) << said();
  EXPECT_EQ(previous.epoch, 7U);
  EXPECT_EQ(mapping::differing_nodes(*previous.resumed->map, *small), 0U);
  EXPECT_EQ(previous.resumed->scans.front().stamp, at(0.1));
}

TEST_F(SavingTest, AMapWithoutItsPoseFileHasAPoseOfItsOwn) {
  const auto map = mapping::random_map<mapping::SemanticOcTree>(2, 50);
  drive(2, 5, 1, *map);
  std::filesystem::remove(folder / Generations::kStateFile);
  const PreviousRun previous = look(1);
  ASSERT_TRUE(previous.resumed) << said();
  const SavedState& found = previous.resumed->state;
  EXPECT_GT(found.T_odom_base.mean.translation().x(), 0.1);
  EXPECT_NEAR(found.T_odom_base.mean.translation().x(), to_seconds(found.stamp), 1e-9);
}

TEST_F(SavingTest, ALostScanMovesNothing) {
  const auto map = mapping::random_map<mapping::SemanticOcTree>(2, 50);
  drive(0, 5, 1, *map);
  TrackPoint lost{at(0.6), {}, Vector6::Zero(), 1};
  lost.lost = true;
  in.pose.publish(lost);
  task.save(at(0.6));
  EXPECT_EQ(look(1).resumed->state.stamp, at(0.4));
}

}  // namespace
}  // namespace cairn::app
