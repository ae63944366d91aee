// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/deskew.hpp"

namespace cairn::odometry {

Deskew::Deskew(const Vector6& twist, const SE3& T_base_lidar, double duration_s) {
  const double step = duration_s / static_cast<double>(kSegments);
  for (std::size_t k = 0; k <= kSegments; ++k) {
    const SE3 T_end_k = SE3::exp(-step * static_cast<double>(k) * twist) * T_base_lidar;
    pose_[k] = T_end_k.matrix().cast<float>();
  }
  for (std::size_t k = 0; k < kSegments; ++k) slope_[k] = pose_[k + 1] - pose_[k];
  slope_[kSegments].setZero();
  knots_per_second_ = duration_s > 0 ? static_cast<float>(1.0 / step) : 0.0F;
}

}  // namespace cairn::odometry
