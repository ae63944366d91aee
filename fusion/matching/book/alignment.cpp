// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/alignment.hpp"

#include <Eigen/SVD>

namespace cairn::matching {

void Alignment::add(const Eigen::Vector3d& source, const Eigen::Vector3d& target, double weight) {
  weight_ += weight;
  squares_ += weight * (target - source).squaredNorm();
  ++pairs_;
  source_ += weight * source;
  target_ += weight * target;
  products_ += weight * target * source.transpose();
}

SE3 Alignment::solve() const {
  if (pairs_ < kLeastPairs || !(weight_ > 0)) return {};
  const Eigen::Vector3d source = source_ / weight_, target = target_ / weight_;
  const Eigen::Matrix3d spread = products_ / weight_ - target * source.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // No mirror image.
  const double handed = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d R = svd.matrixU() * Eigen::Vector3d(1, 1, handed).asDiagonal() * svd.matrixV().transpose();
  return SE3(R, target - R * source);
}

}  // namespace cairn::matching
