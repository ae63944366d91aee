// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/projection.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::labelling {

using Eigen::Vector3d;
using Eigen::Vector3f;

Projection::Projection(const cameras::CameraModel& camera, const SE3& T_base_camera, double line_time_us)
    : camera_(camera),
      T_optical_base_((T_base_camera * cameras::T_camera_optical()).inverse()),
      line_time_s_(1e-6 * line_time_us) {}

Projection::Motion Projection::to_camera(const SE3& T_odom_scan, const Exposure& exposure, double row) const {
  const SE3 T_odom_base = exposure.T_odom_base * SE3::exp(exposure.twist * (row * line_time_s_));
  const SE3 T = T_optical_base_ * T_odom_base.inverse() * T_odom_scan;
  return {T.rotation(), T.translation()};
}

void Projection::add(std::uint32_t index, const Vector3d& p) {
  if (const auto pixel = camera_.project(p))
    seen_.push_back({index, static_cast<float>(pixel->x()), static_cast<float>(pixel->y()), static_cast<float>(p.z()),
                     static_cast<float>(p.norm())});
}

void Projection::add_rolling(std::uint32_t index, const Vector3f& point) {
  constexpr int kRounds = 2;  // a row's error shrinks by the speed of the picture over the shutter's: far below one
  std::size_t row = rows_.size() / 2;
  for (int i = 0; i < kRounds; ++i) {
    const auto pixel = camera_.project(rows_[row] * point);
    if (!pixel) return;
    row = static_cast<std::size_t>(std::clamp<long>(std::lround(pixel->y()), 0, camera_.height() - 1));
  }
  add(index, rows_[row] * point);
}

std::span<const Projected> Projection::project(std::span<const Vector3f> points, const SE3& T_odom_scan,
                                               const Exposure& exposure) {
  seen_.clear();
  const auto count = static_cast<std::uint32_t>(points.size());
  if (!(line_time_s_ > 0)) {
    const Motion motion = to_camera(T_odom_scan, exposure, 0);
    for (std::uint32_t i = 0; i < count; ++i) add(i, motion * points[i]);
    return seen_;
  }
  rows_.clear();
  for (int row = 0; row < camera_.height(); ++row) rows_.push_back(to_camera(T_odom_scan, exposure, row));
  for (std::uint32_t i = 0; i < count; ++i) add_rolling(i, points[i]);
  return seen_;
}

}  // namespace cairn::labelling
