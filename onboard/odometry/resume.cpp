// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/odometry.hpp"

#include <cmath>

namespace cairn {
namespace {

// Where a robot was carried to, less of what it sees is known. Restarts, also after a metre of braking: 0.89 and more
// of the share before. Carried away by 4 m to 14 m: 0.76 at most, but 0.88 once, along an office corridor, where all
// looks alike; who is that quick to carry a robot away is not prepared for.
constexpr double kFoundAgain = 0.82;
constexpr double kGate = 0.2;

/// Whoever was restarted stands, or nearly: its motors' own watchdog saw to that, after at most a third of a second
/// since its pose was saved. A wider search would find more that looks alike: a car park repeats every 2.5 m.
MotionFilter::Uncertainty resumed(const Matrix6& pose, const Vector6& twist) {
  constexpr double kPosition = 0.15, kAngle = 0.15, kSpeed = 0.2, kTurn = 0.2;  // m, rad, m/s, rad/s
  constexpr double kGoesOn = 0.17;                                              // s, a third of the longest way to rest
  Vector12 sigma;
  sigma << kPosition + kGoesOn * twist.head<3>().cwiseAbs().array(),
      kAngle + kGoesOn * twist.tail<3>().cwiseAbs().array(), Eigen::Vector3d::Constant(kSpeed),
      Eigen::Vector3d::Constant(kTurn);
  MotionFilter::Uncertainty uncertainty;
  uncertainty.local = sigma.cwiseAbs2().asDiagonal();
  uncertainty.total = uncertainty.local;
  uncertainty.total.topLeftCorner<6, 6>() += pose;
  return uncertainty;
}

}  // namespace

void LidarOdometry::resume(const UncertainPose& T_odom_base, const Vector6& twist, Time stamp,
                           std::span<const PlacedScan> scans) {
  last_stamp_ = stamp;
  const MotionFilter::Uncertainty uncertainty = resumed(T_odom_base.covariance, twist);
  filter_.reset({T_odom_base.mean, Vector6::Zero()}, uncertainty);
  resumed_ = {T_odom_base.mean, 3 * std::sqrt(uncertainty.local.topLeftCorner<3, 3>().trace())};
  begin_map();
  guesses_left_ = 0;  // the search after a gap finds more than a speed
  for (const PlacedScan& scan : scans) {
    if (&scan == &scans.back()) resumed_->known_share = known_share(scan);
    const Eigen::Matrix3d R = scan.T_odom_base.rotation();
    map_points_.clear();
    for (const Eigen::Vector3f& p : scan.points_base)
      map_points_.push_back(R * p.cast<double>() + scan.T_odom_base.translation());
    drift_.advance(scan.T_odom_base, odom_covariance());
    insert_points(scan.T_odom_base);
  }
}

double LidarOdometry::known_share(const PlacedScan& scan) {
  const SE3 T_lidar_base = T_base_lidar_.inverse();
  points_lidar_.clear();
  in_range_.clear();
  for (const Eigen::Vector3f& p : scan.points_base) {
    in_range_.push_back(static_cast<std::uint32_t>(points_lidar_.size()));
    points_lidar_.push_back((T_lidar_base * p.cast<double>()).cast<float>());
  }
  age_s_.assign(points_lidar_.size(), 0);
  duration_s_ = 0;
  choose_keypoints();
  if (keypoints_.empty()) return 0;
  return inliers({scan.T_odom_base, Vector6::Zero()}, kGate) / static_cast<double>(keypoints_.size());
}

bool LidarOdometry::found_again(const Fit& found) const {
  const NormalEquations& n = found.equations;
  const auto seen = static_cast<double>(keypoints_.size());
  const SE3 motion = resumed_->T_odom_base.inverse() * found.state.T_odom_base;
  return n.matched >= config_.min_matches && n.inliers >= kFoundAgain * resumed_->known_share * seen &&
         motion.translation().norm() <= resumed_->farthest_m;
}

}  // namespace cairn
