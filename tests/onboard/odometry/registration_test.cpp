// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/registration.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/onboard/odometry/room_points.hpp"

namespace cairn::odometry {
namespace {

constexpr double kDuration_s = 0.1;
const SE3 kMount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0.02, -0.05, 0.3).finished());
const SE3 kTruth = SE3::from_xyz_rpy((Vector6() << 0.7, 0.2, 0.1, 0.03, -0.02, 0.8).finished());
const Vector6 kTwist = (Vector6() << 1.2, 0.1, -0.1, 0.1, -0.2, 0.8).finished();
const Vector6 kOff = (Vector6() << 0.06, -0.05, 0.04, 0.01, -0.01, 0.02).finished();

/// A room that is mapped, a scan of it, and a prediction that is a little off.
class RegistrationInARoom : public ::testing::Test {
 protected:
  RegistrationInARoom()
      : map_({.finest_block_m = 0.5, .max_blocks = 1 << 14, .max_points_per_block = 400, .criteria = {}}) {
    map_.insert(Room(1).points(30000, 0.01), Room::sensor(), 3, workers_);
    scan_room(3, 2000, 0.01);
    predict(0.1);
  }
  void scan_room(unsigned seed, std::size_t points, double noise_m) {
    keypoints_.clear();
    std::mt19937 random(seed - 1);
    std::uniform_real_distribution<double> age(0, kDuration_s);
    for (const Eigen::Vector3d& p : Room(seed).points(points, noise_m)) {
      const double tau = age(random);
      const SE3 T_odom_lidar = kTruth * SE3::exp(-tau * kTwist) * kMount;
      keypoints_.push_back({(T_odom_lidar.inverse() * p).cast<float>(), static_cast<float>(tau)});
    }
  }
  void predict(double sigma, const Vector6& off = kOff) {
    MotionFilter::Uncertainty uncertainty;
    uncertainty.local = uncertainty.total = sigma * sigma * Matrix12::Identity();
    filter_.reset({kTruth * SE3::exp(off), kTwist}, uncertainty);
  }
  [[nodiscard]] Selection scan() const { return {.for_map = {}, .keypoints = keypoints_, .duration_s = kDuration_s}; }
  Fit align(int steps, const OdometryConfig& config = {}) {
    Registration registration(config, kMount, workers_);
    Budget budget = Budget::steps(steps);
    Fit fit = registration.align(scan(), map_, filter_, filter_.state(), budget);
    used_ = registration.uses().size();
    return fit;
  }
  static Vector6 error(const Fit& fit) { return (fit.state.T_odom_base.inverse() * kTruth).log(); }

  Workers workers_{1};
  PatchMap map_;
  std::vector<Keypoint> keypoints_;
  MotionFilter filter_;
  std::size_t used_ = 0;
};

TEST_F(RegistrationInARoom, FindsTheBaseAndHowItMoved) {
  predict(0.05);
  const Fit fit = align(100);
  EXPECT_TRUE(fit.converged);
  EXPECT_LT(error(fit).head<3>().norm(), 0.005) << error(fit).transpose();
  EXPECT_LT(error(fit).tail<3>().norm(), 0.002);
  EXPECT_LT((fit.state.twist - kTwist).norm(), 0.1) << fit.state.twist.transpose();
  EXPECT_EQ(fit.degeneracy.count, 0);
  EXPECT_GT(fit.inlier_ratio(), 0.9);
  EXPECT_LT(fit.rms_m(), 0.02);
  EXPECT_LT(fit.misfit(), 2);
  EXPECT_EQ(used_, keypoints_.size());
}

TEST_F(RegistrationInARoom, StopsAtTheBudgetOrTheConfigsLimit) {
  const Fit one = align(1);
  EXPECT_EQ(one.iterations, 1);
  EXPECT_FALSE(one.converged) << "the first gate is wider than the narrowest";
  EXPECT_LT(error(one).norm(), kOff.norm());
  OdometryConfig config;
  config.max_iterations = 2;
  EXPECT_EQ(align(100, config).iterations, 2);
}

TEST_F(RegistrationInARoom, TheGateBeginsAsWideAsThePredictionIsUncertain) {
  predict(1e-3, Vector6::Zero());
  EXPECT_LT(align(100).iterations, 5);
  predict(3);
  const Fit uncertain = align(100);
  EXPECT_GE(uncertain.iterations, 5) << "2, 1, 0.5, 0.25, 0.2 m";
  EXPECT_LT(error(uncertain).norm(), 0.005);
}

TEST_F(RegistrationInARoom, AStepThatUndoesTheLastOneIsTheEnd) {
  map_.clear();
  map_.insert(Room(1).points(6000, 0.06), Room::sensor(), 3, workers_);  // rough: points change between patches
  OdometryConfig config;
  config.max_iterations = 50;
  int unfinished = 0;
  for (unsigned seed = 6; seed < 106; ++seed) {
    scan_room(seed, 150, 0.06);
    predict(0.1, (seed % 2 == 0 ? 1.0 : -1.3) * kOff);
    unfinished += align(100, config).converged ? 0 : 1;
  }
  EXPECT_LE(unfinished, 1) << "of 100 scans";
}

TEST_F(RegistrationInARoom, MoreKeypointsFitNearerToTheTruth) {
  Registration registration({}, kMount, workers_);
  double before = 0;
  for (const double share : {1.0, 0.5, 0.0}) {
    const double n = registration.inliers(scan(), map_, {kTruth * SE3::exp(share * kOff), kTwist}, 0.2);
    EXPECT_GT(n, before) << share;
    before = n;
  }
  EXPECT_GT(before, 0.9 * static_cast<double>(keypoints_.size()));
}

TEST_F(RegistrationInARoom, InAnEmptyMapThePredictionStays) {
  map_.clear();
  const Fit fit = align(100);
  EXPECT_LT((filter_.state().T_odom_base.inverse() * fit.state.T_odom_base).log().norm(), 1e-9);
  EXPECT_EQ(fit.degeneracy.count, 6);
  EXPECT_EQ(fit.inlier_ratio(), 0);
  EXPECT_EQ(fit.rms_m(), 0);
  EXPECT_EQ(fit.misfit(), 1);
}

TEST_F(RegistrationInARoom, GivesTheSameBitsForAnyNumberOfThreads) {
  const Fit one = align(100);
  Workers four(4);
  Registration registration({}, kMount, four);
  Budget budget = Budget::steps(100);
  const Fit fit = registration.align(scan(), map_, filter_, filter_.state(), budget);
  EXPECT_EQ(fit.state.T_odom_base.matrix(), one.state.T_odom_base.matrix());
  EXPECT_EQ(fit.state.twist, one.state.twist);
  EXPECT_EQ(fit.equations.aa, one.equations.aa);
}

}  // namespace
}  // namespace cairn::odometry
