// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/rejoin/rejoin_plan.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <optional>
#include <utility>

#include "fusion/merging/moved_map.hpp"
#include "onboard/app/rejoin/joined_track.hpp"
#include "onboard/mapping/tree/tile_state.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::app {
namespace {

const SE3 kMount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished());
constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

RobotConfig quick_to_give_up() {
  RobotConfig config;
  config.T_base_lidar = kMount;
  config.mapping.reserve_mb = 1;
  config.odometry.give_up_after = config.odometry.reinitialise_after = 2;
  return config;
}

/// A robot that mapped a room, was carried into a corridor in the dark, and maps that.
struct Carried {
  Workers workers{1};
  Monitor monitor;
  Robot robot{quick_to_give_up(), workers, workers, monitor};
  RejoinPlan plan{robot, monitor};
  support::World room;
  support::Scene corridor = support::corridor();
  support::Vlp16 lidar{kMount, 0.02, 1};
  Time now{};
  int scans = 0;

  Carried() { room.box({-4, -3, 0}, {6, 4, 3}).box({2, 2, 0}, {3, 3, 1.5}).box({-2, -2.5, 0}, {-1, -1.5, 1}); }
  void map(const support::World& world, const SE3& at, int count) {
    for (int i = 0; i < count; ++i) {
      const Scan scan = lidar.scan(
          world, [&](double) { return at; }, 0.1 * scans++);
      now = scan.valid.end;
      Budget budget = Budget::steps(12);
      LocatedScan located;
      ASSERT_TRUE(robot.locate(scan, budget, located));
      ASSERT_TRUE(robot.extend_map(located));
      plan.went_to(located.T_odom_base.mean, located.epoch);
    }
  }
  void map_the_room() { map(room, SE3(), 4); }
  void be_carried() {
    scans += 80;
    map(corridor.world, support::pose_on(corridor.ride, 0), 6);
    ASSERT_EQ(robot.map_epoch(), 2U);
  }
  /// Of at most some thousand steps.
  std::optional<RejoinJob> next_job() {
    for (int i = 0; i < 2000; ++i)
      if (auto job = plan.step(now)) return job;
    return std::nullopt;
  }
  RejoinJob found(RejoinJob job, const SE3& T) const {
    job.present.reset();
    job.moved = merging::moved_map(*job.earlier, T).value();
    job.tiles = mapping::known_tiles(*job.moved, kAll);
    job.T_present_earlier = UncertainPose{T, Matrix6::Identity() * 1e-4};
    return job;
  }
};

const SE3 kPlace = SE3::from_xyz_rpy((Vector6() << 1, -7, 0, 0, 0, 0.4).finished());

TEST(RejoinPlan, ComparesAnEarlierMapWithACopyOfThePresentOne) {
  Carried carried;
  carried.map_the_room();
  EXPECT_FALSE(carried.next_job()) << "there is no earlier map";
  carried.be_carried();
  const auto job = carried.next_job();
  ASSERT_TRUE(job);
  EXPECT_EQ(job->earlier_epoch, 1U);
  EXPECT_EQ(job->present_epoch, 2U);
  const EarlierMap& earlier = carried.robot.earlier_maps().all().front();
  EXPECT_EQ(job->earlier, earlier.tree);
  ASSERT_TRUE(job->guess && earlier.T_next_earlier);
  EXPECT_EQ(job->guess->mean.matrix(), earlier.T_next_earlier->mean.matrix());
  job->present->canonicalise();
  EXPECT_EQ(mapping::differing_nodes(*job->present, carried.robot.map()), 0U);
  EXPECT_FALSE(carried.next_job()) << "one is out";
}

/// A map of a small room has its size after the first scan.
TEST(RejoinPlan, ComparesAgainWhenTheRobotHasGoneOn) {
  Carried carried;
  carried.map_the_room();
  carried.be_carried();
  const auto compare = [&] {
    carried.now += 10 * RejoinPlan::kPeriod;
    auto job = carried.next_job();
    if (job) carried.plan.take(*std::move(job), carried.now);
    return job.has_value();
  };
  EXPECT_TRUE(compare());
  EXPECT_FALSE(compare()) << "it stands";
  const SE3 here = carried.robot.track().back().T_odom_base.mean;
  const auto go = [&](double x_m, double yaw) {
    carried.plan.went_to(here * SE3::exp((Vector6() << x_m, 0, 0, 0, 0, yaw).finished()), carried.robot.map_epoch());
  };
  for (double x_m = 0; x_m < 0.85; x_m += 0.1) go(x_m, 0);
  EXPECT_FALSE(compare()) << "not far enough";
  for (double x_m = 0.85; x_m < 1.1; x_m += 0.1) go(x_m, 0);
  EXPECT_TRUE(compare());
  for (double yaw = 0; yaw < 1.1; yaw += 0.1) go(1.05, yaw);
  EXPECT_TRUE(compare()) << "a camera saw other things";
  for (double x_m = 1.05; x_m < 40; x_m += 0.1) go(x_m, 1);
  EXPECT_TRUE(compare());
  for (double x_m = 40; x_m < 44; x_m += 0.1) go(x_m, 1);
  EXPECT_FALSE(compare()) << "after a long way it is asked more seldom";
  for (double x_m = 44; x_m < 45.5; x_m += 0.1) go(x_m, 1);
  EXPECT_TRUE(compare());
}

TEST(RejoinPlan, JoinsWhatIsNotKnownYetAndKeepsWhatIs) {
  Carried carried;
  carried.map_the_room();
  const std::vector<TrackPoint> in_the_room = carried.robot.track();
  carried.be_carried();
  auto job = carried.next_job();
  ASSERT_TRUE(job);
  mapping::SemanticOcTree expected(carried.robot.map());
  RejoinJob result = carried.found(*std::move(job), kPlace);
  for (const mapping::TileKey tile : result.tiles) (void)mapping::fill_tile(expected, tile, *result.moved);
  (void)carried.robot.take_changed_tiles();
  carried.plan.take(std::move(result), carried.now);
  EXPECT_FALSE(carried.next_job()) << "both are one";
  EXPECT_EQ(mapping::differing_nodes(carried.robot.map(), expected), 0U);
  EXPECT_FALSE(carried.robot.changed_tiles().empty()) << "who copies the map hears of it";
  ASSERT_TRUE(carried.robot.earlier_maps().all().front().joined);
  const auto track = joined_track(carried.robot);
  ASSERT_GT(track.size(), in_the_room.size());
  for (std::size_t i = 0; i < in_the_room.size(); ++i)
    EXPECT_TRUE(track[i].T_odom_base.mean.matrix().isApprox((kPlace * in_the_room[i].T_odom_base.mean).matrix()));
  EXPECT_EQ(track.back().T_odom_base.mean.matrix(), carried.robot.track().back().T_odom_base.mean.matrix());
}

TEST(RejoinPlan, AtTheEndOfTheRunTheRestIsJoinedAtOnce) {
  Carried carried;
  carried.map_the_room();
  carried.be_carried();
  auto job = carried.next_job();
  ASSERT_TRUE(job);
  carried.plan.take(carried.found(*std::move(job), kPlace), carried.now);
  carried.plan.finish(carried.now);
  EXPECT_TRUE(carried.robot.earlier_maps().all().front().joined);
}

TEST(RejoinPlan, OnlyOfTheMapJustBeforeIsItsPlaceGuessed) {
  Carried carried;
  carried.map_the_room();
  carried.be_carried();
  carried.scans += 80;
  carried.map(carried.room, SE3(), 6);
  ASSERT_EQ(carried.robot.map_epoch(), 3U);
  for (const std::uint32_t epoch : {1U, 2U}) {
    carried.now += 10 * RejoinPlan::kPeriod;
    auto job = carried.next_job();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->earlier_epoch, epoch);
    EXPECT_EQ(job->guess.has_value(), epoch == 2);
    carried.plan.take(*std::move(job), carried.now);
  }
}

TEST(RejoinPlan, AResultForAMapThatHasEndedIsIgnored) {
  Carried carried;
  carried.map_the_room();
  carried.be_carried();
  auto job = carried.next_job();
  ASSERT_TRUE(job);
  RejoinJob late = carried.found(*std::move(job), kPlace);
  carried.scans += 80;
  carried.map(carried.room, SE3(), 6);
  ASSERT_EQ(carried.robot.map_epoch(), 3U);
  const mapping::SemanticOcTree before(carried.robot.map());
  carried.plan.take(std::move(late), carried.now);
  carried.plan.finish(carried.now);
  EXPECT_EQ(mapping::differing_nodes(carried.robot.map(), before), 0U);
  EXPECT_FALSE(carried.robot.earlier_maps().all().front().joined);
}

}  // namespace
}  // namespace cairn::app
