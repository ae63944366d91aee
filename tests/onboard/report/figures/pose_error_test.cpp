// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/pose_error.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/onboard/report/sample_report.hpp"

namespace cairn::report {
namespace {

const SE3 kWorld = SE3::from_xyz_rpy((Vector6() << 4, -1, 2, 0.1, 0.2, 2).finished());

/// 2000 poses, with errors of 0.02 in all six axes; they claim that variance times `claimed`.
RunReport drawn(double claimed) {
  std::mt19937 engine(4);
  std::normal_distribution<double> noise(0, 0.02);
  RunReport r;
  for (int i = 0; i < 2000; ++i) {
    const SE3 truth = sample::pose_at(0.1 * i);
    Vector6 error = Vector6::Zero();
    for (double& e : error) e = i == 0 ? 0 : noise(engine);
    r.trajectory.push_back(
        {at_seconds(0.1 * i), {truth * SE3::exp(error), claimed * 0.02 * 0.02 * Matrix6::Identity()}});
    r.ground_truth.push_back({at_seconds(0.1 * i), kWorld * truth});
  }
  return r;
}

TEST(PoseErrors, AreSeenInTheRobotsOwnAxes) {
  // The robot looks along the world's y; it is really 0.3 m further ahead than it believes.
  const SE3 left = SE3::from_xyz_rpy((Vector6() << 0, 0, 0, 0, 0, M_PI / 2).finished());
  const SE3 ahead = left * SE3(Eigen::Quaterniond::Identity(), {0.3, 0, 0});
  const std::vector<PoseEstimate> estimate{{at_seconds(0), {left, Matrix6::Zero()}},
                                           {at_seconds(1), {left, Matrix6::Identity()}}};
  const std::vector<StampedPose> truth{{at_seconds(0), left}, {at_seconds(1), ahead}};
  const auto errors = pose_errors(estimate, truth, from_seconds(2));
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_NEAR(errors[1].error(0), 0.3, 1e-12);
  EXPECT_NEAR(errors[1].error(1), 0, 1e-12);
  EXPECT_NEAR(errors[1].distance_m, 0.3, 1e-12);
  EXPECT_EQ(errors[1].sigma(0), 1);
  EXPECT_EQ(errors[0].sigma(0), 0);
}

TEST(PoseErrors, OfAnHonestCovarianceLieInside3Sigma) {
  const RunReport r = drawn(1);
  const auto shares = share_inside_3_sigma(pose_errors(r.trajectory, r.ground_truth, from_seconds(0.2)));
  for (const auto& share : shares) EXPECT_NEAR(share.value(), 0.9973, 0.005);
}

TEST(PoseErrors, OfAnOverconfidentCovarianceDoNot) {
  const RunReport r = drawn(1.0 / 9);  // claims a third of the true deviation: 3 σ is 1 σ
  const auto shares = share_inside_3_sigma(pose_errors(r.trajectory, r.ground_truth, from_seconds(0.2)));
  for (const auto& share : shares) EXPECT_NEAR(share.value(), 0.683, 0.04);
}

TEST(PoseErrors, WithoutClaimOrTruthSayNothing) {
  RunReport r = drawn(0);
  for (const auto& share : share_inside_3_sigma(pose_errors(r.trajectory, r.ground_truth, from_seconds(0.2))))
    EXPECT_FALSE(share.has_value());
  EXPECT_TRUE(pose_errors(r.trajectory, {}, from_seconds(0.2)).empty());
  EXPECT_TRUE(pose_errors({}, r.ground_truth, from_seconds(0.2)).empty());
}

TEST(PoseErrors, KeepEachPosesOwnClaimWhenSomeHaveNoTruth) {
  RunReport r = drawn(1);
  for (std::size_t i = 0; i < r.trajectory.size(); ++i)
    r.trajectory[i].T_odom_base.covariance(0, 0) = static_cast<double>(i * i);
  r.ground_truth.erase(r.ground_truth.begin(), r.ground_truth.begin() + 500);
  const auto errors = pose_errors(r.trajectory, r.ground_truth, from_seconds(0.01));
  ASSERT_EQ(errors.size(), 1500U);
  EXPECT_NEAR(errors.front().sigma(0), 500, 1e-9);
  EXPECT_NEAR(errors.back().sigma(0), 1999, 1e-9);
}

}  // namespace
}  // namespace cairn::report
