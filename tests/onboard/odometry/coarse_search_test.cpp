// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/coarse_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/onboard/odometry/room_points.hpp"

namespace cairn::odometry {
namespace {

SE3 pose(double x, double y, double yaw) { return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished()); }

Matrix12 uncertain(double position_m, double heading_rad) {
  Vector12 sigma = Vector12::Constant(0.01);
  sigma[0] = sigma[1] = position_m;
  sigma[5] = heading_rad;
  return sigma.cwiseAbs2().asDiagonal();
}

class CoarseSearchInARoom : public ::testing::Test {
 protected:
  CoarseSearchInARoom() {
    Workers workers(1);
    map_.insert(Room(1).points(20000, 0.01), Room::sensor(), 0, workers);
  }
  /// Places for points of the walls and the pole, as a base at `truth` sees them.
  std::span<const MotionState> find(const SE3& truth, const Matrix12& covariance, double dt_s) {
    keypoints_.clear();
    for (const Eigen::Vector3d& p : Room(2).points(600, 0.01)) {
      const bool level = p.z() < Room::kLow.z() + 0.1 || p.z() > Room::kLow.z() + Room::kSize.z() - 0.1;
      if (!level) keypoints_.push_back({(truth.inverse() * p).cast<float>(), 0});
    }
    return search_.find({.for_map = {}, .keypoints = keypoints_, .duration_s = 0}, map_, {}, covariance, dt_s);
  }

  PatchMap map_{{.finest_block_m = 0.5, .max_blocks = 1 << 12, .max_points_per_block = 400, .criteria = {}}};
  CoarseSearch search_{SE3()};
  std::vector<Keypoint> keypoints_;
};

TEST_F(CoarseSearchInARoom, FindsAJerkBetweenTwoScans) {
  for (const double yaw : {-0.52, 0.25, 0.52}) {
    const auto places = find(pose(0.3, -0.2, yaw), uncertain(0.15, 0.18), 0.1);
    ASSERT_FALSE(places.empty());
    const SE3 error = places.front().T_odom_base.inverse() * pose(0.3, -0.2, yaw);
    EXPECT_LT(error.translation().norm(), 0.5) << yaw;
    EXPECT_LT(rotation_angle(error), 0.07) << yaw;
    EXPECT_NEAR(places.front().twist[5], rotation_angle(places.front().T_odom_base) / 0.1 * (yaw > 0 ? 1 : -1), 1e-6);
  }
}

TEST_F(CoarseSearchInARoom, AfterAGapItLooksFartherAround) {
  const SE3 truth = pose(1.5, -1.0, 1.8);
  const auto places = find(truth, uncertain(1.0, 1.2), 1.0);
  EXPECT_TRUE(std::ranges::any_of(places, [&](const MotionState& place) {
    const SE3 error = place.T_odom_base.inverse() * truth;
    return error.translation().norm() < 0.9 && rotation_angle(error) < 0.13;
  }));
}

TEST_F(CoarseSearchInARoom, PlacesDifferByMoreThanRegistrationReaches) {
  const auto places = find(pose(0.5, 0.5, 0.4), uncertain(0.5, 0.5), 0.5);
  EXPECT_LE(places.size(), CoarseSearch::kPlaces);
  EXPECT_GE(places.size(), 2u);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const SE3 apart = places[i].T_odom_base.inverse() * places[k].T_odom_base;
      EXPECT_TRUE(apart.translation().norm() > 0.59 || rotation_angle(apart) > 0.125);
    }
}

TEST_F(CoarseSearchInARoom, WithoutPointsThePredictionComesFirst) {
  const std::vector<Keypoint> none;
  const auto places =
      search_.find({.for_map = {}, .keypoints = none, .duration_s = 0}, map_, {}, uncertain(0.2, 0.2), 0.1);
  ASSERT_FALSE(places.empty());
  EXPECT_EQ(places.front().T_odom_base.log().norm(), 0) << "nothing tells places apart";
}

}  // namespace
}  // namespace cairn::odometry
