// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/landmark_map.hpp"

#include <Eigen/LU>
#include <utility>

#include "onboard/visual_odometry/landmark_view.hpp"

namespace cairn::visual_odometry {

const Landmark* LandmarkMap::find(std::uint32_t id) const {
  const auto at = landmarks_.find(id);
  return at == landmarks_.end() ? nullptr : &at->second;
}

void LandmarkMap::add(const Feature& feature, const SE3& T_odom_eye, float epoch) {
  if (!feature.disparity || *feature.disparity < least_disparity_) return;
  const Eigen::Vector3d p_eye = geometry_.point(feature.left.x(), feature.left.y(), *feature.disparity);
  if (p_eye.z() < kNearest_m) return;
  const Eigen::Matrix3d J = T_odom_eye.rotation() * geometry_.jacobian(p_eye).inverse();
  Landmark landmark;
  landmark.p_odom = T_odom_eye * p_eye;
  landmark.covariance = J * noise_.variances().asDiagonal() * J.transpose();
  landmark.epoch = epoch;
  landmarks_.insert_or_assign(feature.id, landmark);
}

void LandmarkMap::move(std::uint32_t id, const Eigen::Vector3d& p_odom, const Eigen::Matrix3d& covariance) {
  const auto at = landmarks_.find(id);
  if (at == landmarks_.end()) return;
  at->second.p_odom = p_odom;
  at->second.covariance = covariance;
}

void LandmarkMap::keep(std::span<const Feature> features) {
  std::unordered_map<std::uint32_t, Landmark> kept;
  for (const Feature& f : features)
    if (const auto at = landmarks_.find(f.id); at != landmarks_.end()) kept.insert(*at);
  landmarks_ = std::move(kept);
}

}  // namespace cairn::visual_odometry
