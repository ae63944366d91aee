// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "hal/se3.hpp"

namespace cairn::odometry {

/// Takes points measured at different times of one scan into base_link at the scan's stamp, for a
/// base that moved with a constant twist: p_base(stamp) = exp(−τ·twist)·T_base_lidar·p_lidar, τ =
/// stamp − firing time.
///
/// Exact at 32 knots and linear in the matrix between them: at 2 rad/s and 100 m the error is below
/// 1 mm.
class Deskew {
 public:
  /// `twist` of base_link in base_link (m/s, rad/s), right-perturbation order (translation,
  /// rotation). Ages beyond `duration_s` are clamped to it.
  Deskew(const Vector6& twist, const SE3& T_base_lidar, double duration_s);

  /// `age_s` = τ ≥ 0 in seconds.
  [[nodiscard]] Eigen::Vector3f operator()(const Eigen::Vector3f& p_lidar, float age_s) const {
    const float position = std::min(age_s * knots_per_second_, kLastKnot);
    const auto k = static_cast<std::size_t>(position);
    const float f = position - static_cast<float>(k);
    const Knot& a = pose_[k];
    const Knot& d = slope_[k];
    const Eigen::Vector4f q = (a.col(0) + f * d.col(0)) * p_lidar.x() + (a.col(1) + f * d.col(1)) * p_lidar.y() +
                              (a.col(2) + f * d.col(2)) * p_lidar.z() + (a.col(3) + f * d.col(3));
    return q.head<3>();
  }

 private:
  /// Per scan. The error of linear parts is (ω·duration/32)²·range/8: 0.5 mm at 2 rad/s, 0.1 s and
  /// 100 m.
  static constexpr std::size_t kSegments = 32;
  static constexpr float kLastKnot = static_cast<float>(kSegments);
  using Knot = Eigen::Matrix4f;  // columns are the rotated axes and the origin

  std::array<Knot, kSegments + 1> pose_;
  std::array<Knot, kSegments + 1> slope_;  // pose_[k + 1] − pose_[k]; zero for the last
  float knots_per_second_ = 0;
};

}  // namespace cairn::odometry
