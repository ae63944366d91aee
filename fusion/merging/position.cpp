// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/position.hpp"

#include <Eigen/Cholesky>

namespace cairn::merging {

Eigen::Matrix3d voxel_covariance(double occupancy, double edge_m) {
  return edge_m * edge_m / 4 / occupancy * Eigen::Matrix3d::Identity();
}

Position moved(const UncertainPose& T_a_b, const Position& in_b) {
  const Eigen::Matrix3d R = T_a_b.mean.rotation();
  Eigen::Matrix<double, 3, 6> F;
  F << R, -R * hat(in_b.mean);
  return {T_a_b.mean * in_b.mean, F * T_a_b.covariance * F.transpose() + R * in_b.covariance * R.transpose()};
}

Position product(const Position& first, const Position& second) {
  // Kalman's form of the same: needs one inverse, and no other one when a covariance is tiny.
  const Eigen::Matrix3d sum = first.covariance + second.covariance;
  const Eigen::Matrix3d gain = sum.ldlt().solve(first.covariance).transpose();
  const Eigen::Matrix3d covariance = first.covariance - gain * first.covariance;
  return {first.mean + gain * (second.mean - first.mean), 0.5 * (covariance + covariance.transpose())};
}

}  // namespace cairn::merging
