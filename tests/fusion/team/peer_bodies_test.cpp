// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/peer_bodies.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace cairn::team {
namespace {

using peers::Bodies;
using peers::Exchange;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kQuarter = std::numbers::pi / 2;

SE3 pose_of_peer(double x, double y, double yaw) {
  return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished());
}

/// Robot 1 hears of a person and of robot 2 itself, which stands at the origin of its odom and drives along x.
class PeerBodiesTest : public ::testing::Test {
 protected:
  PeerBodiesTest() {
    Bodies bodies;
    bodies.robot = {.position_m = {0, 0, 0}, .velocity_m_s = {1, 0}, .radius_m = 0.5, .height_m = 0.8};
    bodies.people.push_back({.id = 4, .position_m = {2, 1, 0.1}, .velocity_m_s = {0, -1}});
    bodies.people[0].covariance << 0.04, 0, 0, 0.01;
    talk();
    other_.set_bodies(bodies, now_);
    talk();
  }
  void talk() {
    for (int i = 0; i < 3; ++i, now_ += milliseconds(100)) {
      std::vector<peers::Outgoing> out;
      other_.send(now_, out);
      for (const auto& datagram : out) EXPECT_TRUE(own_.receive(datagram.bytes, now_));
      out.clear();
      own_.send(now_, out);
      for (const auto& datagram : out) EXPECT_TRUE(other_.receive(datagram.bytes, now_));
    }
  }
  Exchange own_{1, "one", 5}, other_{2, "two", 6};
  Time now_{seconds(50)};
  std::map<peers::RobotId, SE3> poses_{{1, pose_of_peer(0, 0, 0)}, {2, pose_of_peer(10, 0, kQuarter)}};
};

TEST_F(PeerBodiesTest, AreInThisRobotsOdomAndPredicted) {
  const auto all = bodies_of_peers(own_, poses_, now_);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].robot, 2U);
  EXPECT_EQ(all[0].age, milliseconds(300));
  EXPECT_LT((all[0].body.position_m - Eigen::Vector3d(10, 0.3, 0)).norm(), 1e-6);
  EXPECT_LT((all[0].body.velocity_m_s - Eigen::Vector2d(0, 1)).norm(), 1e-6);
  ASSERT_EQ(all[0].people.size(), 1U);
  const Bodies::Person& person = all[0].people[0];
  EXPECT_EQ(person.id, 4U);
  EXPECT_LT((person.position_m - Eigen::Vector3d(9.3, 2, 0.1)).norm(), 1e-6);
  EXPECT_LT((person.velocity_m_s - Eigen::Vector2d(1, 0)).norm(), 1e-6);
  EXPECT_GT(person.covariance(1, 1), 0.04) << "turned, and grown";
  EXPECT_LT(person.covariance(0, 0), 0.02);
}

TEST_F(PeerBodiesTest, OfAPeerWhosePlaceIsNotKnownNothingIsSaid) {
  poses_.erase(2);
  EXPECT_TRUE(bodies_of_peers(own_, poses_, now_).empty());
  EXPECT_TRUE(bodies_of_peers(own_, {}, now_).empty());
}

TEST_F(PeerBodiesTest, ExpireSoon) {
  EXPECT_FALSE(bodies_of_peers(own_, poses_, now_ + seconds(1)).empty());
  EXPECT_TRUE(bodies_of_peers(own_, poses_, now_ + seconds(2)).empty());
}

TEST_F(PeerBodiesTest, AnOdomThatHasEndedIsVoid) {
  other_.begin(9);
  now_ += seconds(1);
  talk();
  EXPECT_TRUE(bodies_of_peers(own_, poses_, now_ - seconds(1)).empty());
}

}  // namespace
}  // namespace cairn::team
