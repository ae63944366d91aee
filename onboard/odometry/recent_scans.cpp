// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/recent_scans.hpp"

namespace cairn::odometry {

bool ScanSelection::wants(const SE3& T_odom_base) const {
  const SE3 motion = T_odom_last_.inverse() * T_odom_base;
  return taken_ < kFirst || motion.translation().norm() > kStretch_m || rotation_angle(motion) > kTurn_rad;
}

void ScanSelection::take(const SE3& T_odom_base) {
  ++taken_;
  T_odom_last_ = T_odom_base;
}

void ScanThinning::operator()(std::span<const Eigen::Vector3f> points_base, std::vector<Eigen::Vector3f>& out) {
  near_.clear();
  for (std::size_t i = 0; i < points_base.size(); ++i)
    if (points_base[i].norm() <= static_cast<float>(range_m_)) near_.push_back(static_cast<std::uint32_t>(i));
  out.clear();
  for (const std::uint32_t i : subsample_(points_base, near_, static_cast<float>(edge_m_)))
    out.push_back(points_base[i]);
}

void RecentScans::add(PlacedScan scan) {
  scans_.push_back(std::move(scan));
  if (scans_.size() > kScans) scans_.pop_front();
}

}  // namespace cairn::odometry
