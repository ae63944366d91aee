// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/landmark_map.hpp"

#include <Eigen/LU>
#include <utility>

namespace cairn::visual_odometry {
namespace {

constexpr double kBeforeEye_m = 0.1;  // of a landmark before the eye
constexpr double kRefiningGate = 16;  // χ² of a view that may refine a landmark

}  // namespace

const Landmark* LandmarkMap::find(std::uint32_t id) const {
  const auto at = landmarks_.find(id);
  return at == landmarks_.end() ? nullptr : &at->second;
}

void LandmarkMap::add(const Feature& feature, const SE3& T_odom_eye, float epoch) {
  if (!feature.disparity || *feature.disparity < least_disparity_) return;
  const Eigen::Vector3d p_eye = geometry_.point(feature.left.x(), feature.left.y(), *feature.disparity);
  if (p_eye.z() < kBeforeEye_m) return;
  const Eigen::Matrix3d J = T_odom_eye.rotation() * geometry_.jacobian(p_eye).inverse();
  Landmark landmark;
  landmark.p_odom = T_odom_eye * p_eye;
  landmark.covariance = J * noise_.variances().asDiagonal() * J.transpose();
  landmark.epoch = epoch;
  landmarks_.insert_or_assign(feature.id, landmark);
}

void LandmarkMap::refine(const Feature& feature, const SE3& T_odom_eye) {
  const auto at = landmarks_.find(feature.id);
  if (at == landmarks_.end()) return;
  Landmark& landmark = at->second;
  const Eigen::Vector3d p_eye = T_odom_eye.inverse() * landmark.p_odom;
  if (p_eye.z() < kBeforeEye_m) return;
  const Eigen::Matrix3d H = geometry_.jacobian(p_eye) * T_odom_eye.rotation().transpose();
  Eigen::Vector3d variances = noise_.variances();
  Eigen::Vector3d seen(feature.left.x(), feature.left.y(), 0);
  const Eigen::Vector3d expected = geometry_.project(p_eye);
  if (feature.disparity) {
    seen.z() = *feature.disparity;
  } else {
    seen.z() = expected.z();
    variances.z() = 1e6;
  }
  const Eigen::Matrix3d S = H * landmark.covariance * H.transpose() + Eigen::Matrix3d(variances.asDiagonal());
  const Eigen::Matrix3d S_inverse = S.inverse();
  const Eigen::Vector3d innovation = seen - expected;
  if (innovation.dot(S_inverse * innovation) > kRefiningGate) return;
  const Eigen::Matrix3d K = landmark.covariance * H.transpose() * S_inverse;
  landmark.p_odom += K * innovation;
  const Eigen::Matrix3d P = (Eigen::Matrix3d::Identity() - K * H) * landmark.covariance;
  landmark.covariance = 0.5 * (P + P.transpose());
}

void LandmarkMap::keep(std::span<const Feature> features) {
  std::unordered_map<std::uint32_t, Landmark> kept;
  for (const Feature& f : features)
    if (const auto at = landmarks_.find(f.id); at != landmarks_.end()) kept.insert(*at);
  landmarks_ = std::move(kept);
}

}  // namespace cairn::visual_odometry
