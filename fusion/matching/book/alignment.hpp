// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "hal/se3.hpp"

namespace cairn::matching {

/// Sums over weighted pairs of points, and the motion that brings one set closest to the other.
/// Closed form by SVD (Umeyama 1991, without scale). The book uses it in OICP (3.13), PMM's second
/// level and EM.
class Alignment {
 public:
  static constexpr int kLeastPairs = 3;  ///< three points fix a motion

  /// Points in m; the weight has no unit.
  void add(const Eigen::Vector3d& source, const Eigen::Vector3d& target, double weight = 1);
  [[nodiscard]] int pairs() const { return pairs_; }
  /// Mean squared distance of the pairs as they were added, m².
  [[nodiscard]] double mean_squared() const { return weight_ > 0 ? squares_ / weight_ : 0; }
  /// T with target ≈ T·source. Identity with fewer than kLeastPairs.
  [[nodiscard]] SE3 solve() const;

 private:
  double weight_ = 0, squares_ = 0;
  int pairs_ = 0;
  Eigen::Vector3d source_ = Eigen::Vector3d::Zero(), target_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
};

}  // namespace cairn::matching
