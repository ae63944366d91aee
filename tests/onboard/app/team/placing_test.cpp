// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/placing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/fusion/team/two_teams.hpp"

namespace cairn::app {
namespace {

using clients::Placement;
using ::testing::HasSubstr;

Placement placed_in(const char* frame) { return {clients::ShortText<32>(frame), 10, -5, 1.2, 0.3, 0.05}; }

SE3 somewhere() { return SE3::from_xyz_rpy((Vector6() << 4, 2, 0.7, 0.03, -0.02, -2.5).finished()); }

TEST(Placing, PutsBaseLinkWhereItWasSaid) {
  const SE3 T_odom_base = somewhere();
  const UncertainPose T = T_frame_odom(placed_in(""), T_odom_base);
  const SE3 T_frame_base = T.mean * T_odom_base;
  EXPECT_LT((T_frame_base.translation() - Eigen::Vector3d(10, -5, 0.7)).norm(), 1e-9) << "the height is the robot's";
  const Eigen::Vector3d x = T_frame_base.rotation().col(0);
  EXPECT_NEAR(std::atan2(x.y(), x.x()), 1.2, 1e-9);
  EXPECT_LT((T_frame_base.rotation().row(2) - T_odom_base.rotation().row(2)).norm(), 1e-9) << "so are roll and pitch";
}

/// The far origin of odom is known less well than the robot: the heading moves it.
TEST(Placing, IsAsSureOfTheRobotAsWasSaid) {
  const UncertainPose T = T_frame_odom(placed_in(""), somewhere());
  const UncertainPose base = compose(T, {somewhere(), Matrix6::Zero()});
  const Eigen::Matrix3d R = base.mean.rotation();
  const Eigen::Matrix3d in_frame = R * base.covariance.topLeftCorner<3, 3>() * R.transpose();
  EXPECT_NEAR(std::sqrt(in_frame(0, 0)), 0.3, 0.02);
  EXPECT_NEAR(std::sqrt(base.covariance(5, 5)), 0.05, 0.003);
  const auto spread = [](const UncertainPose& pose) { return pose.covariance(0, 0) + pose.covariance(1, 1); };
  EXPECT_GT(spread(T), spread(base));
}

TEST(Placing, FramesAreTeammates) {
  team::Team a(fleet::team_member(1), peers::Epoch{1} << 32U), b(fleet::team_member(2), peers::Epoch{1} << 32U);
  Time now{std::chrono::seconds(100)};
  EXPECT_FALSE(robot_of_frame(placed_in("robot_1"), b)) << "never heard of";
  fleet::talk(a, b, now, std::chrono::seconds(3));
  EXPECT_EQ(robot_of_frame(placed_in("robot_1"), b).value(), 1U);
  EXPECT_EQ(robot_of_frame(placed_in(""), b).value(), 0U);
  EXPECT_EQ(robot_of_frame(placed_in("robot_9"), b).error().code, Errc::kNotFound);
  EXPECT_EQ(robot_of_frame(placed_in("team"), b).error().code, Errc::kNotFound) << "it has merged with nobody";
}

TEST(Placing, IsToldInWords) {
  EXPECT_EQ(to_string(placed_in("robot_1")), "it was placed at (10.00, -5.00), 69 degrees, in odom of robot_1");
  EXPECT_THAT(to_string(placed_in("")), HasSubstr("the frame of start poses"));
  EXPECT_THAT(to_string(placed_in("team")), HasSubstr("the team's map"));
  EXPECT_THAT(to_string(Placement{}), HasSubstr("taken back"));
}

}  // namespace
}  // namespace cairn::app
