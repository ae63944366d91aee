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
  EXPECT_EQ(job->earlier, carried.robot.earlier_maps().all().front().tree);
  job->present->canonicalise();
  EXPECT_EQ(mapping::differing_nodes(*job->present, carried.robot.map()), 0U);
  EXPECT_FALSE(carried.next_job()) << "one is out";
}

TEST(RejoinPlan, ComparesAgainWhenTheMapHasGrown) {
  Carried carried;
  carried.map_the_room();
  carried.be_carried();
  auto job = carried.next_job();
  ASSERT_TRUE(job);
  carried.plan.take(*std::move(job), carried.now);
  carried.now += 10 * RejoinPlan::kPeriod;
  EXPECT_FALSE(carried.next_job()) << "the map is the same";
  const std::size_t before = carried.robot.map().size();
  for (double phi = 0.1; carried.robot.map().size() < before * 6 / 5; phi += 0.1)
    carried.map(carried.corridor.world, support::pose_on(carried.corridor.ride, phi), 1);
  carried.now += 10 * RejoinPlan::kPeriod;
  EXPECT_TRUE(carried.next_job());
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
