// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/plane.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace cairn {
namespace {

/// |c| ≤ 0.3 edge on one grid or on the staggered one: their distances add up to half an edge.
bool cut_by_a_face(const Eigen::Vector3f& normal, const Eigen::Vector3f& centroid, float edge) {
  Eigen::Index axis = 0;
  return normal.cwiseAbs().maxCoeff(&axis) > 0.7F && std::abs(centroid[axis]) > 0.3F * edge;
}

}  // namespace

Plane fit_plane(const Moments& m, float edge, const PlaneCriteria& criteria) {
  if (m.count < criteria.min_points) return {};
  const float scale = 1.0F / m.count;
  const Eigen::Vector3f mean = scale * m.sum;
  Eigen::Matrix3f covariance;
  covariance << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  covariance = (covariance - m.sum * mean.transpose()) / (m.count - 1.0F);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen(covariance);
  Plane plane;
  plane.normal = eigen.eigenvectors().col(0);
  plane.centroid = mean;
  // Three parameters were fitted; few points look flatter than they are.
  const float across = std::max(eigen.eigenvalues()[0], 0.0F) * (m.count - 1.0F) / (m.count - 3.0F);
  const float along = eigen.eigenvalues()[1];
  plane.variance = std::max(across, criteria.noise_floor_m * criteria.noise_floor_m);
  if (across > criteria.max_thickness_m * criteria.max_thickness_m) return {};
  if (along < criteria.min_flatness * plane.variance) return {};
  if (cut_by_a_face(plane.normal, plane.centroid, edge)) return {};
  plane.inverse_spread = 1.0F / along;
  plane.count = m.count;
  plane.epoch = m.epoch_sum * scale;
  if (plane.tilt_variance() > criteria.max_tilt_rad * criteria.max_tilt_rad) return {};
  return plane;
}

}  // namespace cairn
