// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/graph/team_graph.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <random>

namespace cairn::team {
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

/// Robots that have driven on since they began, and whose odometry has drifted as it says that it does.
struct Drifted {
  std::map<merging::SubmapKey, SE3> truth;  // of the submaps
  SubmapChains chains;
  std::vector<PairClaim> claims;

  Drifted(unsigned robots, unsigned submaps, std::mt19937& random) {
    Vector6 sigma;
    sigma << Eigen::Vector3d::Constant(0.25), Eigen::Vector3d::Constant(0.009);
    const Matrix6 drift = sigma.cwiseAbs2().asDiagonal();
    for (peers::RobotId robot = 1; robot <= robots; ++robot) {
      SE3 at = pose(static_cast<double>(robot), 2, 0.4 * static_cast<double>(robot)), odometry;
      truth[{robot, 0}] = at;
      for (std::size_t k = 1; k < submaps; ++k) {
        const SE3 moved = pose(20, 3, 0.3);
        at = at * moved;
        odometry = odometry * moved * noise(sigma, random);
        truth[{robot, static_cast<std::uint16_t>(k)}] = at;
        chains[robot].push_back({odometry, drift});
      }
    }
  }
  static SE3 noise(const Vector6& sigma, std::mt19937& random) {
    std::normal_distribution<> normal;
    Vector6 xi;
    for (Eigen::Index i = 0; i < 6; ++i) xi[i] = sigma[i] * normal(random);
    return SE3::exp(xi);
  }
  void claim(const merging::SubmapKey& a, const merging::SubmapKey& b, bool refined, std::mt19937& random) {
    Vector6 sigma;
    sigma << Eigen::Vector3d::Constant(0.03), Eigen::Vector3d::Constant(0.002);
    const SE3 T = truth.at(a).inverse() * truth.at(b) * noise(sigma, random);
    claims.push_back({a.robot, b.robot, {T, sigma.cwiseAbs2().asDiagonal()}, 0.97, a.submap, b.submap, refined});
  }
  /// The error of where the team puts one submap in another.
  [[nodiscard]] SE3 error(const TeamPoses& team, const merging::SubmapKey& a, const merging::SubmapKey& b) const {
    return (truth.at(a).inverse() * truth.at(b)).inverse() * team.between(a, b)->mean;
  }
};

TEST(TeamGraphWithDrift, SubmapsAreWhereTheyWereSeenAndErrorsAreThoseOfTheCovariances) {
  std::mt19937 random(6);
  double sum = 0;
  int count = 0;
  for (int round = 0; round < 30; ++round) {
    Drifted ride(2, 8, random);
    ride.claim({1, 0}, {2, 0}, false, random);
    for (std::uint16_t k = 0; k < 8; k += 2) ride.claim({1, k}, {2, k}, true, random);
    const TeamPoses team = team_poses(1, ride.claims, ride.chains);
    for (std::uint16_t k = 0; k < 8; ++k) {
      EXPECT_LT(ride.error(team, {1, k}, {2, k}).translation().norm(), k % 2 == 0 ? 0.15 : 2.5);
      const Vector6 e = ride.error(team, {1, k}, {2, k}).log();
      sum += e.dot(team.between({1, k}, {2, k})->covariance.ldlt().solve(e));
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 6, 1) << "χ² with 6 degrees of freedom";
}

TEST(TeamGraphWithDrift, TilesLieWhereTheirSubmapDoes) {
  std::mt19937 random(7);
  Drifted ride(2, 6, random);
  ride.claim({1, 0}, {2, 0}, false, random);
  for (std::uint16_t k = 1; k < 6; ++k) ride.claim({1, k}, {2, k}, true, random);
  const TeamPoses team = team_poses(1, ride.claims, ride.chains);
  for (const auto& [submap, node] : team.nodes) {
    const SE3 placed = team.submaps.at(submap) * place_in_odom(ride.chains, submap.robot, submap.submap);
    const SE3 error = team.graph.poses[node].inverse() * placed;
    EXPECT_LT(error.translation().norm(), 0.06) << "rounded";
    EXPECT_LT(rotation_angle(error), 0.002);
  }
  EXPECT_EQ(team.T_team_odom.at(2).matrix(), team.submaps.at({2, 5}).matrix());
}

TEST(TeamGraphWithDrift, WithoutRefinementMapsStayInOnePiece) {
  std::mt19937 random(8);
  Drifted ride(3, 9, random);
  ride.claim({1, 3}, {2, 5}, false, random);
  const TeamPoses team = team_poses(2, ride.claims, ride.chains);
  EXPECT_EQ(team.submaps.size(), 18U);
  for (const auto& [submap, T] : team.submaps)
    EXPECT_EQ(T.matrix(), team.submaps.at({submap.robot, 0}).matrix()) << submap.robot << "." << submap.submap;
}

TEST(TeamGraphWithDrift, WhoeverAsksAndInWhateverOrderGetsTheSame) {
  std::mt19937 random(9);
  Drifted ride(4, 5, random);
  for (peers::RobotId robot = 2; robot <= 4; ++robot) {
    ride.claim({1, 1}, {robot, 1}, false, random);
    for (std::uint16_t k = 0; k < 5; ++k) ride.claim({1, k}, {robot, k}, true, random);
  }
  ride.claims.back().T_a_b.mean = ride.claims.back().T_a_b.mean * pose(5, 0, 1);
  const TeamPoses first = team_poses(1, ride.claims, ride.chains);
  for (peers::RobotId self = 1; self <= 4; ++self) {
    std::shuffle(ride.claims.begin(), ride.claims.end(), random);
    const TeamPoses other = team_poses(self, ride.claims, ride.chains);
    ASSERT_EQ(other.submaps.size(), 20U);
    for (const auto& [submap, T] : first.submaps) EXPECT_EQ(other.submaps.at(submap).matrix(), T.matrix());
  }
}

TEST(TeamGraphWithDrift, WrongRefinementsAreLeftOut) {
  std::mt19937 random(10);
  std::uniform_real_distribution<> off(2, 4);
  int wrong_kept = 0, right_lost = 0;
  for (int round = 0; round < 30; ++round) {
    Drifted ride(2, 12, random);
    ride.claim({1, 0}, {2, 0}, false, random);
    for (std::uint16_t k = 0; k < 12; ++k) ride.claim({1, k}, {2, k}, true, random);
    for (const std::size_t wrong : {4U, 7U, 8U})
      ride.claims[wrong].T_a_b.mean = ride.claims[wrong].T_a_b.mean * pose(off(random), off(random), 0.1);
    const TeamPoses team = team_poses(1, ride.claims, ride.chains);
    for (std::size_t i = 0; i < ride.claims.size(); ++i) {
      const bool wrong = i == 4 || i == 7 || i == 8;
      wrong_kept += wrong && team.kept[i] ? 1 : 0;
      right_lost += !wrong && !team.kept[i] ? 1 : 0;
    }
  }
  EXPECT_LE(wrong_kept, 9) << "of 90";
  EXPECT_LE(right_lost, 9) << "of 300";
}

TEST(TeamGraphWithDrift, WhatIsNotKnownYetIsLeftOut) {
  std::mt19937 random(11);
  Drifted ride(2, 4, random);
  ride.claim({1, 0}, {2, 0}, false, random);
  ride.claim({1, 3}, {2, 3}, true, random);
  ride.chains[2].pop_back();  // its last submap has not arrived
  const TeamPoses team = team_poses(1, ride.claims, ride.chains);
  EXPECT_EQ(team.kept, (std::vector<bool>{true, false}));
  EXPECT_FALSE(team.between({1, 0}, {2, 3}));
  ride.claims[0].submap_b = 3;
  EXPECT_EQ(team_poses(1, ride.claims, ride.chains).T_team_odom.size(), 1U);
}

TEST(TeamGraphWithDrift, RefinementsConnectNobody) {
  std::mt19937 random(12);
  Drifted ride(2, 4, random);
  ride.claim({1, 0}, {2, 0}, true, random);
  EXPECT_EQ(team_poses(1, ride.claims, ride.chains).T_team_odom.size(), 1U);
}

}  // namespace
}  // namespace cairn::team
