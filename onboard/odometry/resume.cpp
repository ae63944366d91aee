// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/odometry.hpp"

namespace cairn {
namespace {

/// Whoever was restarted stands, or nearly: its motors' own watchdog saw to that. Where it came to stand is not known
/// to the centimetre, and the map it is placed in is one of voxels.
MotionFilter::Uncertainty resumed(const Matrix6& pose) {
  constexpr double kPosition = 0.3, kAngle = 0.15, kSpeed = 0.3, kTurn = 0.3;  // m, rad, m/s, rad/s
  Vector12 sigma;
  sigma << Eigen::Vector3d::Constant(kPosition), Eigen::Vector3d::Constant(kAngle), Eigen::Vector3d::Constant(kSpeed),
      Eigen::Vector3d::Constant(kTurn);
  MotionFilter::Uncertainty uncertainty;
  uncertainty.local = sigma.cwiseAbs2().asDiagonal();
  uncertainty.total = uncertainty.local;
  uncertainty.total.topLeftCorner<6, 6>() += pose;
  return uncertainty;
}

}  // namespace

void LidarOdometry::resume(const UncertainPose& T_odom_base, Time stamp, std::span<const Eigen::Vector3f> points_odom) {
  last_stamp_ = stamp;
  filter_.reset({T_odom_base.mean, Vector6::Zero()}, resumed(T_odom_base.covariance));
  begin_map();
  guesses_left_ = 0;  // the search after a gap finds more than a speed
  const Eigen::Vector3d& centre = T_odom_base.mean.translation();
  map_points_.clear();
  for (const Eigen::Vector3f& p : points_odom)
    if (p.allFinite() && (p.cast<double>() - centre).norm() < config_.window_m) map_points_.push_back(p.cast<double>());
  drift_.advance(T_odom_base.mean, odom_covariance());
  insert_points();
}

}  // namespace cairn
