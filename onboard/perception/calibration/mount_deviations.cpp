// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/mount_deviations.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "onboard/perception/calibration/board.hpp"

namespace cairn::calibration {

Vector6 mount_deviations(const SE3& T_points_camera, const Matrix6& sigma) {
  constexpr double kStep = 1e-6;
  Matrix6 by;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Vector6 xi = kStep * Vector6::Unit(i);
    Vector6 change = (SE3::exp(-xi) * T_points_camera).xyz_rpy() - (SE3::exp(xi) * T_points_camera).xyz_rpy();
    for (Eigen::Index k = 3; k < 6; ++k) change[k] = std::remainder(change[k], 2 * std::numbers::pi);
    by.col(i) = change / (2 * kStep);
  }
  if (sigma.allFinite()) return (by * sigma * by.transpose()).diagonal().cwiseSqrt();
  Vector6 deviations = Vector6::Zero();  // a free direction leaves free whatever depends on it
  for (Eigen::Index k = 0; k < 6; ++k)
    for (Eigen::Index i = 0; i < 6; ++i)
      if (std::abs(by(k, i)) > 1e-6) deviations[k] = std::hypot(deviations[k], by(k, i) * std::sqrt(sigma(i, i)));
  return deviations;
}

std::vector<std::string> mount_faults(const Vector6& deviations, const MountLimits& limits) {
  static constexpr std::array kNames{"x", "y", "z", "roll", "pitch", "yaw"};
  std::vector<std::string> faults;
  for (std::size_t i = 0; i < 6; ++i) {
    const bool place = i < 3;
    const double deviation = deviations[static_cast<Eigen::Index>(i)] / (place ? 1 : kDegree);
    const double limit = place ? limits.place_m : limits.turn_deg;
    if (deviation <= limit) continue;
    const char* unit = place ? "m" : "degrees";
    faults.push_back(
        std::isfinite(deviation)
            ? fmt::format("{} is only known to {:.2g} {}, the limit is {:.2g}", kNames[i], deviation, unit, limit)
            : fmt::format("{} is not determined at all: the boards are all parallel", kNames[i]));
  }
  return faults;
}

}  // namespace cairn::calibration
