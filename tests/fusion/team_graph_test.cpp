// SPDX-License-Identifier: Apache-2.0
#include "fusion/team_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace cairn {
namespace {

SE3 pose(double x, double y, double yaw) {
  Vector6 v;
  v << x, y, 0.1, 0, 0, yaw;
  return SE3::from_xyz_rpy(v);
}

/// Where robots 1 … n truly lie.
std::map<peers::RobotId, SE3> truths(unsigned n, std::mt19937& random) {
  std::uniform_real_distribution<> at(-20, 20), turn(-3, 3);
  std::map<peers::RobotId, SE3> poses;
  for (peers::RobotId id = 1; id <= n; ++id) poses[id] = pose(at(random), at(random), turn(random));
  return poses;
}

PairClaim claim(const std::map<peers::RobotId, SE3>& truth, peers::RobotId a, peers::RobotId b, std::mt19937& random,
                double sigma = 0.02) {
  std::normal_distribution<> noise(0, sigma);
  Vector6 xi;
  for (double& value : xi) value = noise(random) * 0.1;
  xi.head<3>() *= 10;
  Vector6 sigmas;
  sigmas << sigma, sigma, sigma, sigma / 10, sigma / 10, sigma / 10;
  return {a, b, {truth.at(a).inverse() * truth.at(b) * SE3::exp(xi), sigmas.cwiseAbs2().asDiagonal()}, 0.95};
}

double error_of(const TeamPoses& team, const std::map<peers::RobotId, SE3>& truth, peers::RobotId robot) {
  const SE3 T_anchor_robot = truth.at(team.anchor).inverse() * truth.at(robot);
  return (T_anchor_robot.inverse() * team.T_team_odom.at(robot)).translation().norm();
}

TEST(TeamGraph, ARobotAloneIsItsOwnTeam) {
  const TeamPoses team = team_poses(7, {});
  EXPECT_EQ(team.anchor, 7U);
  EXPECT_EQ(team.T_team_odom.at(7).matrix(), Eigen::Matrix4d::Identity());
}

TEST(TeamGraph, PlacesEveryoneAndLoopsHelp) {
  std::mt19937 random(1);
  for (int round = 0; round < 10; ++round) {
    const auto truth = truths(4, random);
    std::vector<PairClaim> chain{claim(truth, 1, 2, random), claim(truth, 3, 2, random), claim(truth, 3, 4, random)};
    const TeamPoses team = team_poses(2, chain);
    EXPECT_EQ(team.anchor, 1U);
    for (peers::RobotId id = 1; id <= 4; ++id) EXPECT_LT(error_of(team, truth, id), 0.6);
    PairClaim exact = claim(truth, 1, 4, random, 1e-4);
    chain.push_back(exact);
    EXPECT_LT(error_of(team_poses(2, chain), truth, 4), 0.01);
  }
}

TEST(TeamGraph, WhoeverAsksAndInWhateverOrderGetsTheSame) {
  std::mt19937 random(2);
  const auto truth = truths(5, random);
  std::vector<PairClaim> claims{claim(truth, 1, 2, random), claim(truth, 2, 3, random), claim(truth, 1, 3, random),
                                claim(truth, 3, 4, random), claim(truth, 4, 5, random), claim(truth, 1, 5, random)};
  const TeamPoses first = team_poses(1, claims);
  for (peers::RobotId self = 1; self <= 5; ++self) {
    std::shuffle(claims.begin(), claims.end(), random);
    const TeamPoses other = team_poses(self, claims);
    ASSERT_EQ(other.T_team_odom.size(), 5U);
    for (const auto& [robot, T] : first.T_team_odom) EXPECT_EQ(other.T_team_odom.at(robot).matrix(), T.matrix());
  }
}

TEST(TeamGraph, AClaimThatClosesNoLoopIsLeftOut) {
  std::mt19937 random(3);
  const auto truth = truths(4, random);
  std::vector<PairClaim> claims{claim(truth, 1, 2, random), claim(truth, 2, 3, random), claim(truth, 3, 4, random),
                                claim(truth, 1, 3, random), claim(truth, 2, 4, random), claim(truth, 1, 4, random)};
  claims[5].T_a_b.mean = claims[5].T_a_b.mean * pose(5, 3, 0.5);
  const TeamPoses team = team_poses(4, claims);
  EXPECT_EQ(team.kept, (std::vector<bool>{true, true, true, true, true, false}));
  for (peers::RobotId id = 1; id <= 4; ++id) EXPECT_LT(error_of(team, truth, id), 0.3);
}

TEST(TeamGraph, TeamsThatHaveNotMetAreApart) {
  std::mt19937 random(4);
  const auto truth = truths(5, random);
  const std::vector<PairClaim> claims{claim(truth, 1, 2, random), claim(truth, 4, 3, random)};
  EXPECT_EQ(team_poses(2, claims).T_team_odom.size(), 2U);
  EXPECT_EQ(team_poses(4, claims).anchor, 3U);
  EXPECT_EQ(team_poses(5, claims).T_team_odom.size(), 1U);
}

TEST(TeamGraph, EightRobotsThatAllHaveMetAreAllPlaced) {
  std::mt19937 random(5);
  const auto truth = truths(8, random);
  std::vector<PairClaim> claims;
  for (peers::RobotId a = 1; a <= 8; ++a)
    for (peers::RobotId b = a + 1; b <= 8; ++b) claims.push_back(claim(truth, a, b, random));
  const TeamPoses team = team_poses(8, claims);
  EXPECT_EQ(team.T_team_odom.size(), 8U);
  for (peers::RobotId id = 1; id <= 8; ++id) EXPECT_LT(error_of(team, truth, id), 0.5);
}

}  // namespace
}  // namespace cairn
