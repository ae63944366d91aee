// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_submaps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/peers/items/claim.hpp"

namespace cairn::peers {
namespace {

constexpr double kTileM = 1.6;

class OwnSubmapsTest : public testing::Test {
 protected:
  void drive(double metres, double step_m) {
    for (double s = 0; s < metres; s += step_m) {
      x_ += step_m;
      submaps_.be_at(at(x_, 3 * std::sin(x_ / 5), 0), exchange_);
    }
  }
  [[nodiscard]] Submap said(std::uint16_t submap) const {
    return decode_submap(exchange_.layers().at(1).holding.items().at(ItemId::submap(submap)).payload).value();
  }

  static UncertainPose at(double x, double y, double yaw, const Matrix6& covariance = Matrix6::Zero()) {
    Vector6 xyz_rpy;
    xyz_rpy << x, y, 0, 0, 0, yaw;
    return {SE3::from_xyz_rpy(xyz_rpy), covariance};
  }

  Exchange exchange_{1, "a", Epoch{1} << 32U};
  OwnSubmaps submaps_{{.length_m = 25}, kTileM};
  double x_ = 0;
};

TEST_F(OwnSubmapsTest, AShortRunHasOneAndSaysNothing) {
  submaps_.be_at(at(1000, 0, 0), exchange_);  // where odom's origin is does not matter
  for (int i = 0; i < 10'000; ++i) submaps_.be_at(at(1000 + 0.05 * (i % 2), 0, 0), exchange_);  // it stands
  EXPECT_EQ(submaps_.current(), 0);
  EXPECT_TRUE(exchange_.layers().at(1).holding.items().empty());
}

TEST_F(OwnSubmapsTest, EachBeginsWhereTheRobotIsOnATileAndDriftsWithThePath) {
  for (std::uint16_t k = 1; k < 5; ++k) {
    while (submaps_.current() < k) drive(0.1, 0.05);
    const UncertainPose T = said(k).T_odom_submap;
    EXPECT_LT((T.mean.translation() - Eigen::Vector3d(x_, 3 * std::sin(x_ / 5), 0)).cwiseAbs().maxCoeff(), 0.81);
    const Eigen::Vector3d tiles = T.mean.translation() / kTileM;
    EXPECT_NEAR((tiles - tiles.array().round().matrix()).norm(), 0, 1e-9);
    EXPECT_NEAR(std::sqrt(T.covariance(1, 1)), 0.25, 0.01);
    EXPECT_NEAR(std::sqrt(T.covariance(5, 5)), 25 * 3.5e-4, 1e-4);
  }
}

/// Along a corridor the way ahead is unsure, whatever the robot's heading.
TEST_F(OwnSubmapsTest, WhatOdometryIsUnsureOfIsSaid) {
  const double yaw = 0.5;
  Matrix6 P = Matrix6::Identity() * 1e-4;
  for (double way = 0; way <= 30 && submaps_.current() == 0; way += 0.5) {
    P(0, 0) = 1e-4 + 0.01 * way;  // m², along the robot's own x: sigma is 0.5 m after 25 m
    submaps_.be_at(at(way * std::cos(yaw), way * std::sin(yaw), yaw, P), exchange_);
  }
  ASSERT_EQ(submaps_.current(), 1);
  const Matrix6 C = said(1).T_odom_submap.covariance;
  const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0), across(-std::sin(yaw), std::cos(yaw), 0);
  const double path = std::sqrt(along.dot(C.topLeftCorner<3, 3>() * along)),
               side = std::sqrt(across.dot(C.topLeftCorner<3, 3>() * across));
  EXPECT_NEAR(path, 0.5, 0.02);
  EXPECT_NEAR(side, 0.25, 0.01) << "the floor";
}

TEST_F(OwnSubmapsTest, OfWhatWasUnsureBeforeNothingIsSaidTwice) {
  const Matrix6 P = Matrix6::Identity();  // since long ago
  for (double way = 0; way < 26; way += 0.5) submaps_.be_at(at(way, 0, 0, P), exchange_);
  ASSERT_EQ(submaps_.current(), 1);
  EXPECT_NEAR(std::sqrt(said(1).T_odom_submap.covariance(0, 0)), 0.25, 0.01);
}

TEST_F(OwnSubmapsTest, ACutBeginsTheNextAndIsAsUnsureAsAWholeOne) {
  submaps_.cut(exchange_);
  EXPECT_EQ(submaps_.current(), 0) << "the robot was nowhere yet";
  drive(5, 0.5);
  submaps_.cut(exchange_);
  EXPECT_EQ(submaps_.current(), 1);
  EXPECT_NEAR(std::sqrt(said(1).T_odom_submap.covariance(0, 0)), 0.25, 1e-6);
}

TEST(AtLeast, KeepsWhatIsLargerAndTheFloorElsewhere) {
  Matrix6 floor = Matrix6::Identity() * 0.01, C = floor;
  EXPECT_EQ(at_least(0.5 * floor, floor), floor);
  C(0, 0) = 4;
  C(1, 1) = 1e-6;
  const Matrix6 both = at_least(C, floor);
  EXPECT_NEAR(both(0, 0), 4, 1e-9);
  EXPECT_NEAR(both(1, 1), 0.01, 1e-9);
  C(0, 0) = std::nan("");
  EXPECT_EQ(at_least(C, floor), floor);
  EXPECT_NEAR(at_least(Matrix6::Identity() * 1e30, floor)(2, 2), 0.01 * kMostTimes, 1e-3);
  EXPECT_EQ(at_least(-Matrix6::Identity(), floor), floor);
}

TEST_F(OwnSubmapsTest, ABeginningBeginsWithTheFirst) {
  drive(80, 0.5);
  ASSERT_GE(submaps_.current(), 3);
  submaps_.clear();
  EXPECT_EQ(submaps_.current(), 0);
  drive(5, 0.5);
  EXPECT_EQ(submaps_.current(), 0) << "the way before does not count";
}

TEST_F(OwnSubmapsTest, ThereIsALastOne) {
  drive(200 * OwnSubmaps::kMost, 30);
  EXPECT_EQ(submaps_.current(), OwnSubmaps::kMost - 1);
}

}  // namespace
}  // namespace cairn::peers
