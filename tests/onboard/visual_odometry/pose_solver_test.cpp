// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/pose_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/stereo_view.hpp"

namespace cairn::visual_odometry {
namespace {

using odometry::MotionFilter;
const stereo::StereoGeometry kSolverEyes = support::small_eyes();
const SE3 kSolverMount =
    SE3::from_xyz_rpy((Vector6() << 0.1, 0, 0.2, 0, 0.3, 0).finished()) * cameras::T_camera_optical();

/// Landmarks before a robot at `T_odom_base`, seen with noise; the first `wrong` of them anywhere.
std::vector<Match> matches_from(const SE3& T_odom_base, int count, int wrong, double noise_px, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(20, 236), v(20, 140), depth(2, 9);
  std::normal_distribution<double> noise(0, std::max(noise_px, 1e-9));
  std::vector<Match> matches;
  for (int i = 0; i < count; ++i) {
    Match m;
    m.id = static_cast<std::uint32_t>(i);
    const double z = depth(random);
    const Eigen::Vector3d pixel(u(random), v(random), kSolverEyes.fx * kSolverEyes.baseline_m / z);
    m.landmark.p_odom = T_odom_base * kSolverMount * kSolverEyes.point(pixel.x(), pixel.y(), pixel.z());
    m.landmark.covariance = 1e-8 * Eigen::Matrix3d::Identity();
    m.seen = i < wrong ? Eigen::Vector3d(u(random), v(random), kSolverEyes.fx * kSolverEyes.baseline_m / depth(random))
                       : Eigen::Vector3d(pixel + Eigen::Vector3d(noise(random), noise(random), noise(random)));
    matches.push_back(m);
  }
  return matches;
}

/// A prediction at the origin that knows little.
MotionFilter vague() {
  MotionFilter filter;
  MotionFilter::Uncertainty u;
  u.local = u.total = odometry::Matrix12::Identity();
  filter.reset({}, u);
  filter.predict(0.1, odometry::MotionNoise::of(10, 10));
  return filter;
}

/// More steps than usual.
VisualOdometryConfig patient() {
  VisualOdometryConfig config;
  config.max_iterations = 15;
  return config;
}

SE3 moved(double x, double yaw) {
  return SE3::from_xyz_rpy((Vector6() << x, 0.05, -0.02, 0.02, -0.03, yaw).finished());
}

TEST(PoseSolver, FindsThePoseFromExactViews) {
  const SE3 truth = moved(0.3, 0.1);
  const auto matches = matches_from(truth, 60, 0, 0, 1);
  Budget budget = Budget::steps(20);
  const MotionFilter filter = vague();
  const Fit fit = PoseSolver(patient(), kSolverEyes, kSolverMount).align(matches, filter, filter.state(), budget);
  EXPECT_LT((fit.state.T_odom_base.inverse() * truth).log().norm(), 2e-3);
  EXPECT_EQ(fit.inliers, 60);
  EXPECT_TRUE(fit.converged);
}

TEST(PoseSolver, AThirdOfWrongMatchesIsLeftAlone) {
  const SE3 truth = moved(0.1, 0.03);
  const auto matches = matches_from(truth, 120, 40, 0.3, 2);
  Budget budget = Budget::steps(20);
  const MotionFilter filter = vague();
  const Fit fit = PoseSolver(patient(), kSolverEyes, kSolverMount).align(matches, filter, filter.state(), budget);
  EXPECT_LT((fit.state.T_odom_base.inverse() * truth).log().norm(), 0.02);
  EXPECT_GT(fit.inliers, 70);
  EXPECT_LT(fit.inliers, 90);
}

TEST(PoseSolver, VotingFindsAPoseThatIsFarFromThePrediction) {
  const SE3 truth = moved(1.2, 0.5);
  const auto matches = matches_from(truth, 100, 50, 0.3, 3);
  const PoseSolver solver({}, kSolverEyes, kSolverMount);
  const SE3 found = solver.vote(matches, {});
  EXPECT_LT((found.inverse() * truth).log().norm(), 0.1);
  EXPECT_LT((solver.vote(matches, {}).inverse() * found).log().norm(), 1e-15);  // always the same draws
}

TEST(PoseSolver, TooFewMatchesLeaveTheStart) {
  const PoseSolver solver({}, kSolverEyes, kSolverMount);
  const auto matches = matches_from(moved(0.1, 0), 2, 0, 0, 4);
  const SE3 start = moved(0.05, 0);
  EXPECT_LT((solver.vote(matches, {start, Vector6::Zero()}).inverse() * start).log().norm(), 1e-12);
}

/// A robot that turns while the rows of its picture are exposed: what is seen belongs to many poses.
TEST(PoseSolver, EachRowIsOfItsOwnTime) {
  const SE3 truth = moved(0.1, 0.03);
  odometry::MotionState state{.T_odom_base = {}, .twist = (Vector6() << 1.5, 0, 0, 0.1, -0.2, 1.2).finished()};
  auto matches = matches_from(truth, 60, 0, 0, 5);
  for (Match& m : matches) {
    m.row_s = 1e-4 * m.seen.y();
    const SE3 then = truth * SE3::exp(m.row_s * state.twist);
    m.seen = kSolverEyes.project((then * kSolverMount).inverse() * m.landmark.p_odom);
  }
  const auto off = [&](const std::vector<Match>& seen) {
    const PoseSolver solver(patient(), kSolverEyes, kSolverMount);
    MotionFilter filter = vague();
    filter.believe(state);
    Budget budget = Budget::steps(20);
    const Fit fit = solver.align(seen, filter, {solver.vote(seen, state), state.twist}, budget);
    return (fit.state.T_odom_base.inverse() * truth).log().norm();
  };
  auto at_once = matches;
  for (Match& m : at_once) m.row_s = 0;
  EXPECT_LT(off(matches), 2e-3);
  EXPECT_GT(off(at_once), 0.01);
}

TEST(PoseSolver, TheBudgetLimitsTheSteps) {
  const auto matches = matches_from(moved(0.3, 0.1), 60, 0, 0, 1);
  Budget budget = Budget::steps(1);
  const MotionFilter filter = vague();
  EXPECT_EQ(PoseSolver({}, kSolverEyes, kSolverMount).align(matches, filter, filter.state(), budget).iterations, 1);
}

}  // namespace
}  // namespace cairn::visual_odometry
