// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/graph/pose_graph.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace cairn::team {
namespace {

Matrix6 spread(double metres, double radians) {
  Vector6 sigma;
  sigma << Eigen::Vector3d::Constant(metres), Eigen::Vector3d::Constant(radians);
  return sigma.cwiseAbs2().asDiagonal();
}

SE3 disturbed(const SE3& T, const Matrix6& covariance, std::mt19937& random) {
  std::normal_distribution<> normal;
  Vector6 xi;
  for (Eigen::Index i = 0; i < 6; ++i) xi[i] = std::sqrt(covariance(i, i)) * normal(random);
  return T * SE3::exp(xi);
}

/// A path with odometry that drifts from node to node, and some looks back that do not.
struct Path {
  std::vector<SE3> truth, odometry{SE3()};
  std::vector<RelativePose> known;

  Path(std::size_t nodes, std::mt19937& random) : truth{SE3()} {
    const Matrix6 drift = spread(0.25, 0.009);
    std::uniform_real_distribution<> turn(-1, 1);
    while (truth.size() < nodes) {
      Vector6 ahead;
      ahead << 20, 2 * turn(random), 0, 0, 0, turn(random);
      const SE3 moved = SE3::from_xyz_rpy(ahead), measured = disturbed(moved, drift, random);
      truth.push_back(truth.back() * moved);
      odometry.push_back(odometry.back() * measured);
      known.push_back({truth.size() - 2, truth.size() - 1, {measured, drift}});
    }
  }
  void look(std::size_t a, std::size_t b, std::mt19937& random) {
    const Matrix6 covariance = spread(0.03, 0.002);
    known.push_back({a, b, {disturbed(truth[a].inverse() * truth[b], covariance, random), covariance}});
  }
  [[nodiscard]] double error(const PoseGraph& graph, std::size_t node) const {
    return (truth[node].inverse() * graph.poses[node]).translation().norm();
  }
};

TEST(PoseGraph, ErrorsAreThoseOfItsCovariances) {
  std::mt19937 random(1);
  double sum = 0;
  int count = 0;
  for (int round = 0; round < 60; ++round) {
    Path path(8, random);
    path.look(0, 5, random);
    path.look(2, 7, random);
    const PoseGraph graph = solve(path.odometry, path.known);
    const Marginals known(graph);
    for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 4}, {3, 6}, {7, 1}}) {
      const UncertainPose T = known.between(a, b);
      const Vector6 e = (T.mean.inverse() * path.truth[a].inverse() * path.truth[b]).log();
      sum += e.dot(T.covariance.ldlt().solve(e));
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 6, 0.8) << "χ² with 6 degrees of freedom";
}

TEST(PoseGraph, WhatIsLookedAtAgainIsWhereItWas) {
  std::mt19937 random(2);
  for (int round = 0; round < 20; ++round) {
    Path path(12, random);
    for (std::size_t node = 1; node < 12; ++node) path.look(0, node, random);
    const PoseGraph graph = solve(path.odometry, path.known);
    for (std::size_t node = 1; node < 12; ++node) EXPECT_LT(path.error(graph, node), 0.2);
  }
}

TEST(PoseGraph, ANodeAloneStays) {
  const PoseGraph graph = solve({SE3()}, {});
  EXPECT_EQ(graph.poses.front().matrix(), Eigen::Matrix4d::Identity());
}

}  // namespace
}  // namespace cairn::team
