// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/trajectory_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace cairn::report {
namespace {

using Trajectory = std::vector<StampedPose>;

Time at_seconds(double s) { return Time{from_seconds(s)}; }
SE3 planar(double x, double y, double yaw) { return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished()); }

/// 100 m along x at 1 m/s, a pose every 0.1 s.
Trajectory straight(double scale = 1.0) {
  Trajectory t;
  for (int i = 0; i <= 1000; ++i) t.push_back({at_seconds(0.1 * i), planar(0.1 * i * scale, 0, 0)});
  return t;
}

/// A curve in all six degrees of freedom.
Trajectory wild(int poses = 400) {
  Trajectory t;
  for (int i = 0; i < poses; ++i) {
    const double s = 0.1 * i;
    const Vector6 v =
        (Vector6() << 10 * std::sin(0.1 * s), s, std::cos(0.3 * s), 0.2 * std::sin(s), 0.1 * std::cos(s), 0.05 * s)
            .finished();
    t.push_back({at_seconds(s), SE3::from_xyz_rpy(v)});
  }
  return t;
}

Trajectory moved(const Trajectory& t, const SE3& T) {
  Trajectory out = t;
  for (StampedPose& p : out) p.pose = T * p.pose;
  return out;
}

TrajectoryError error_of(const Trajectory& estimate, const Trajectory& truth, Alignment alignment) {
  const auto e = trajectory_error(estimate, truth, {alignment, from_seconds(0.2)});
  EXPECT_TRUE(e.has_value()) << (e ? "" : to_string(e.error()));
  return e.value_or(TrajectoryError{});
}

const SE3 kElsewhere = SE3::from_xyz_rpy((Vector6() << 5, -7, 3, 0.4, -0.3, 2.5).finished());

TEST(TrajectoryError, VanishesForTheSameMotionInAnyFrame) {
  for (const Alignment a : {Alignment::kFirst, Alignment::kSe3}) {
    const TrajectoryError e = error_of(moved(wild(), kElsewhere), wild(), a);
    EXPECT_NEAR(e.ate_rmse_m, 0, 1e-9);
    EXPECT_NEAR(e.final_error_m, 0, 1e-9);
    EXPECT_NEAR(e.segments.value().trans_percent, 0, 1e-6);
    EXPECT_NEAR(e.segments.value().rot_deg_per_m, 0, 1e-5);
  }
}

TEST(TrajectoryError, WithoutAlignmentIsTheOffset) {
  const Trajectory shifted = moved(straight(), planar(0.3, 0.4, 0));
  const TrajectoryError e = error_of(shifted, straight(), Alignment::kNone);
  EXPECT_NEAR(e.ate_rmse_m, 0.5, 1e-12);
  EXPECT_NEAR(e.ate_max_m, 0.5, 1e-12);
  EXPECT_NEAR(e.final_error_m, 0.5, 1e-12);
  EXPECT_NEAR(e.final_error_percent.value(), 0.5, 1e-12);
  EXPECT_NEAR(e.length_m, 100, 1e-9);
  EXPECT_NEAR(e.duration_s, 100, 1e-9);
  EXPECT_EQ(e.matched, 1001U);
  EXPECT_EQ(e.unmatched, 0U);
}

// Scale error 1 %: |error(x)| = 0.01 x. From the first pose the RMS over x ∈ [0, L] is 0.01 L/√3; about the centroid it
// is 0.01 L/√12; relative errors are 1 % in every segment.
TEST(TrajectoryError, OfAScaledLineIsAnalytic) {
  const TrajectoryError e = error_of(straight(1.01), straight(), Alignment::kSe3);
  EXPECT_NEAR(e.ate_first_rmse_m, 1.0 / std::sqrt(3), 1e-3);
  EXPECT_NEAR(e.ate_se3_rmse_m, 1.0 / std::sqrt(12), 1e-3);
  EXPECT_EQ(e.ate_rmse_m, e.ate_se3_rmse_m);
  EXPECT_NEAR(e.final_error_percent.value(), 1, 1e-9);
  EXPECT_NEAR(e.segments.value().trans_percent, 1, 1e-9);
  EXPECT_NEAR(e.segments.value().rot_deg_per_m, 0, 1e-9);
  EXPECT_NEAR(e.steps.value().trans_percent, 1, 1e-9);
  EXPECT_EQ(e.steps.value().segments, 1000U);
}

// A gyro bias of 0.1° per metre: the estimate drives a circle of that curvature.
TEST(TrajectoryError, OfAConstantYawBiasIsTheBias) {
  const double bias = 0.1 * std::numbers::pi / 180;
  Trajectory circle;
  for (const StampedPose& p : straight()) {
    const double x = p.pose.translation().x();
    circle.push_back({p.stamp, planar(std::sin(bias * x) / bias, (1 - std::cos(bias * x)) / bias, bias * x)});
  }
  const TrajectoryError e = error_of(circle, straight(), Alignment::kFirst);
  EXPECT_NEAR(e.segments.value().rot_deg_per_m, 0.1, 1e-9);
  EXPECT_NEAR(e.steps.value().rot_deg_per_m, 0.1, 1e-9);
  const Eigen::Vector3d end = circle.back().pose.translation() - Eigen::Vector3d(100, 0, 0);
  EXPECT_NEAR(e.final_error_m, end.norm(), 1e-9);
  // Segments of 10, 20 … 80 m: the chord error of each, weighted by how many starts it has.
  double sum = 0, starts = 0;
  for (int k = 1; k <= 8; ++k) {
    const double L = 10 * k, n = 1001 - 100 * k;
    const Eigen::Vector2d chord(std::sin(bias * L) / bias - L, (1 - std::cos(bias * L)) / bias);
    sum += n * 100 * chord.norm() / L;
    starts += n;
  }
  EXPECT_NEAR(e.segments.value().trans_percent, sum / starts, 2e-3);
  EXPECT_NEAR(static_cast<double>(e.segments.value().segments), starts, 8);
}

TEST(TrajectoryError, LeastSquaresIsNeverWorseAndStationary) {
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0, 0.1);
  Trajectory noisy = moved(wild(), kElsewhere);
  for (StampedPose& p : noisy)
    p.pose = p.pose * SE3(Eigen::Quaterniond::Identity(), {noise(engine), noise(engine), noise(engine)});
  const std::vector<MatchedPose> matched = match_by_time(noisy, wild(), from_seconds(0.2));
  const SE3 best = align(matched, Alignment::kSe3);
  const auto rmse = [&](const SE3& T) {
    double sum = 0;
    for (const MatchedPose& m : matched) sum += (T * m.estimate.translation() - m.truth.translation()).squaredNorm();
    return std::sqrt(sum / static_cast<double>(matched.size()));
  };
  EXPECT_LT(rmse(best), rmse(align(matched, Alignment::kFirst)));
  for (int k = 0; k < 6; ++k)
    for (const double h : {-1e-3, 1e-3}) EXPECT_GT(rmse(best * SE3::exp(h * Vector6::Unit(k))), rmse(best));
  EXPECT_NEAR(error_of(noisy, wild(), Alignment::kSe3).ate_rmse_m, rmse(best), 1e-12);
}

TEST(TrajectoryError, OnALineLeastSquaresKeepsTheRollOfTheFirstPose) {
  const std::vector<MatchedPose> matched = match_by_time(moved(straight(), kElsewhere), straight(), from_seconds(0.2));
  const SE3 residual = align(matched, Alignment::kSe3) * kElsewhere;
  EXPECT_NEAR(residual.translation().norm(), 0, 1e-9);
  EXPECT_NEAR(rotation_angle(residual), 0, 1e-6);
}

TEST(TrajectoryError, OfARobotThatStoodStillHasNoPercent) {
  Trajectory still;
  for (int i = 0; i < 10; ++i) still.push_back({at_seconds(i * 0.1), planar(1, 2, 0.5)});
  const TrajectoryError e = error_of(still, still, Alignment::kSe3);
  EXPECT_NEAR(e.ate_rmse_m, 0, 1e-12);
  EXPECT_FALSE(e.final_error_percent || e.segments || e.steps);
}

TEST(TrajectoryError, OfAFewSparsePosesIsDividedByTheLengthReallyDriven) {
  // 16 poses 0.86 m apart, each step 1 % too long.
  Trajectory truth, estimate;
  for (int i = 0; i < 16; ++i) {
    truth.push_back({at_seconds(0.1 * i), planar(0.86 * i, 0, 0)});
    estimate.push_back({at_seconds(0.1 * i), planar(0.86 * 1.01 * i, 0, 0)});
  }
  const TrajectoryError e = error_of(estimate, truth, Alignment::kFirst);
  EXPECT_NEAR(e.steps.value().trans_percent, 1, 1e-9);
  EXPECT_NEAR(e.segments.value().trans_percent, 1, 1e-9);
}

TEST(MatchByTime, InterpolatesAndRefusesGaps) {
  const Trajectory truth{
      {at_seconds(0), planar(0, 0, 0)}, {at_seconds(0.1), planar(1, 0, 1.0)}, {at_seconds(1.1), planar(2, 0, 1.0)}};
  Trajectory estimate;
  for (const double t : {-0.01, 0.0, 0.025, 0.1, 0.5, 1.1, 1.2}) estimate.push_back({at_seconds(t), planar(t, 0, 0)});
  const auto matched = match_by_time(estimate, truth, from_seconds(0.2));
  ASSERT_EQ(matched.size(), 4U);  // 0, 0.025, 0.1 and, exactly on the last pose, 1.1
  EXPECT_NEAR(matched[1].truth.translation().x(), 0.25, 1e-9);
  EXPECT_NEAR(matched[1].truth.xyz_rpy()(5), 0.25, 1e-9);
  EXPECT_EQ(matched[3].stamp, at_seconds(1.1));
}

TEST(MatchByTime, OfDifferentTimeLinesIsAnErrorThatSaysSo) {
  Trajectory later = straight();
  for (StampedPose& p : later) p.stamp += from_seconds(1e6);
  const auto e = trajectory_error(later, straight(), {});
  ASSERT_FALSE(e.has_value());
  EXPECT_THAT(to_string(e.error()), testing::HasSubstr("same time line"));
  EXPECT_FALSE(trajectory_error({}, {}, {}).has_value());
}

TEST(TruthInEstimateFrame, LiesOverAnErrorFreeEstimate) {
  const Trajectory estimate = moved(wild(), kElsewhere);
  const auto truth = truth_in_estimate_frame(estimate, wild(), from_seconds(0.2));
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_NEAR((truth[i].pose.translation() - estimate[i].pose.translation()).norm(), 0, 1e-9);
  EXPECT_EQ(truth_in_estimate_frame({}, wild(), from_seconds(0.2)).size(), wild().size());
}

TEST(Alignment, NamesRoundTrip) {
  for (const Alignment a : {Alignment::kFirst, Alignment::kSe3, Alignment::kNone})
    EXPECT_EQ(alignment_from(to_string(a)), a);
  EXPECT_FALSE(alignment_from("umeyama").has_value());
}

}  // namespace
}  // namespace cairn::report
