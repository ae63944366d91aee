// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/onboard/odometry/room_points.hpp"

namespace cairn::odometry {
namespace {

const SE3 kLidarMount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished());

SE3 forward(double metres) { return SE3(Eigen::Quaterniond::Identity(), {metres, 0, 0}); }
Matrix6 variance_of(double variance) { return variance * Matrix6::Identity(); }

/// A scan of the room by a base at this pose.
std::vector<Eigen::Vector3f> room_from(const SE3& T_odom_base) {
  std::vector<Eigen::Vector3f> out;
  for (const Eigen::Vector3d& p : Room(1).points(20000, 0.01)) out.push_back((T_odom_base.inverse() * p).cast<float>());
  return out;
}

std::vector<std::uint32_t> all_of(const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

class LocalMapOfARoom : public ::testing::Test {
 protected:
  LocalMap fresh(const OdometryConfig& config = {}) {
    LocalMap map(config, kLidarMount, workers_);
    map.begin({}, Matrix6::Zero());
    return map;
  }
  Workers workers_{1};
  std::vector<Eigen::Vector3f> points_ = room_from({});
  std::vector<std::uint32_t> all_ = all_of(points_);
};

TEST_F(LocalMapOfARoom, HoldsTheChosenPointsWhereTheBaseSawThem) {
  LocalMap map = fresh();
  map.insert(points_, all_, {}, Matrix6::Zero(), {});
  const std::size_t blocks = map.patches().blocks();
  EXPECT_GT(map.patches().patches(), 100U);

  LocalMap moved = fresh();
  const SE3 T = SE3::from_xyz_rpy((Vector6() << 0.4, -0.3, 0.1, 0, 0, 0.7).finished());
  const auto seen = room_from(T);
  moved.insert(seen, all_of(seen), T, Matrix6::Zero(), {});
  EXPECT_NEAR(static_cast<double>(moved.patches().blocks()), static_cast<double>(blocks),
              0.01 * static_cast<double>(blocks));

  LocalMap few = fresh();
  few.insert(points_, std::span(all_).first(10), {}, Matrix6::Zero(), {});
  EXPECT_LE(few.patches().blocks(), 60U) << "ten points in six grids";
}

TEST_F(LocalMapOfARoom, IsSettledAfterItsFirstScans) {
  OdometryConfig config;
  config.settling_scans = 3;
  LocalMap map = fresh(config);
  map.restore({.stamp = {}, .T_odom_base = {}, .points_base = points_}, Matrix6::Zero());
  EXPECT_GT(map.patches().patches(), 100U) << "what a previous run saw is there";
  for (int scan = 0; scan < 3; ++scan) {
    EXPECT_FALSE(map.settled()) << scan;
    map.insert(points_, all_, {}, Matrix6::Zero(), {});
  }
  EXPECT_TRUE(map.settled());
  map.begin({}, Matrix6::Zero());
  EXPECT_FALSE(map.settled());
  EXPECT_EQ(map.patches().blocks(), 0U);
}

TEST_F(LocalMapOfARoom, WhatARestoredScanHasShownIsLastingWhenTheRobotGoesOn) {
  LocalMap map = fresh();
  const Eigen::Vector3d floor(0.4, 0.3, Room::kLow.z());
  map.restore({.stamp = Time{from_seconds(10)}, .T_odom_base = {}, .points_base = points_}, Matrix6::Zero());
  map.insert(points_, all_, {}, Matrix6::Zero(), Time{from_seconds(15)});
  EXPECT_TRUE(map.patches().match(floor, {0, 0, 1}, 0.2F).lasting);

  LocalMap seen_once = fresh();
  seen_once.insert(points_, {}, {}, Matrix6::Zero(), Time{from_seconds(10)});
  seen_once.insert(points_, all_, {}, Matrix6::Zero(), Time{from_seconds(15)});
  EXPECT_FALSE(seen_once.patches().match(floor, {0, 0, 1}, 0.2F).lasting);
}

TEST_F(LocalMapOfARoom, ARestoredScanIsAnInsertedOne) {
  LocalMap inserted = fresh(), restored = fresh();
  const SE3 T = SE3::from_xyz_rpy((Vector6() << 0.4, -0.3, 0.1, 0, 0, 0.7).finished());
  const auto seen = room_from(T);
  inserted.insert(seen, all_of(seen), T, variance_of(2), {});
  restored.restore({.stamp = {}, .T_odom_base = T, .points_base = seen}, variance_of(2));
  EXPECT_EQ(restored.patches().blocks(), inserted.patches().blocks());
  EXPECT_EQ(restored.patches().patches(), inserted.patches().patches());
}

TEST_F(LocalMapOfARoom, ForgetsWhatIsFarBehindOnceTheBaseHasMovedATenthOfTheWindow) {
  OdometryConfig config;
  config.window_m = 20;
  LocalMap map = fresh(config);
  map.insert(points_, all_, {}, Matrix6::Zero(), {});
  const std::size_t blocks = map.patches().blocks();
  map.insert(points_, {}, forward(1.9), Matrix6::Zero(), {});
  EXPECT_EQ(map.patches().blocks(), blocks);
  map.insert(points_, {}, forward(18), Matrix6::Zero(), {});
  EXPECT_LT(map.patches().blocks(), blocks);
  EXPECT_GT(map.patches().blocks(), 0U);
  map.insert(points_, {}, forward(40), Matrix6::Zero(), {});
  EXPECT_EQ(map.patches().blocks(), 0U);
}

TEST_F(LocalMapOfARoom, KnowsHowUncertainThePoseWasWhenEachPartWasMade) {
  LocalMap map = fresh();
  map.insert(points_, all_, {}, variance_of(0), {});
  map.insert(points_, {}, forward(1), variance_of(4), {});
  map.insert(points_, {}, forward(2), variance_of(9), {});
  const std::vector<KeypointUse> first{{1, 0}}, second{{1, 1}}, third{{1, 2}};
  EXPECT_EQ(map.drift(first), variance_of(0));
  EXPECT_EQ(map.drift(second), variance_of(4));
  EXPECT_EQ(map.drift(third), variance_of(9));
}

}  // namespace
}  // namespace cairn::odometry
