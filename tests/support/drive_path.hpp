// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "hal/se3.hpp"

namespace cairn::support {

/// A differential-drive ride along a closed plane curve: starts at rest, then as fast as speed and turning rate allow.
struct Ride {
  std::function<Eigen::Vector2d(double)> curve;  ///< over a parameter in radians
  double max_speed = 1.5;                        ///< m/s
  double max_turn = 0.8;                         ///< rad/s
  double rest_s = 1.0;                           ///< standing still at first
  double lag_s = 0.4;                            ///< until about two thirds of a new speed are reached
  double wobble_rad = 0.0;                       ///< amplitude of roll and pitch, for bodies on springs and drones
  std::function<double(double, double)> ground = [](double, double) { return 0.0; };  ///< height over x, y
};

/// The ride as a function of time, smooth to numerical precision between table entries 5 ms apart.
class RidePath {
 public:
  RidePath(Ride ride, double seconds) : ride_(std::move(ride)) {
    const auto n = static_cast<std::size_t>(seconds / kStep) + 4;
    double phi = 0, rate = 0;
    for (std::size_t i = 0; i < n; ++i) {
      phi_.push_back(phi);
      // A first-order lag keeps the acceleration bounded.
      rate += kStep / ride_.lag_s * (target_rate(phi, kStep * static_cast<double>(i)) - rate);
      phi += kStep * rate;
    }
  }

  [[nodiscard]] SE3 operator()(double t) const {
    const double phi = parameter(t);
    const Eigen::Vector2d p = ride_.curve(phi);
    const double yaw = heading(phi), h = 1e-3;
    const auto& z = ride_.ground;
    const Eigen::Vector3d up = Eigen::Vector3d((z(p.x() - h, p.y()) - z(p.x() + h, p.y())) / (2 * h),
                                               (z(p.x(), p.y() - h) - z(p.x(), p.y() + h)) / (2 * h), 1.0)
                                   .normalized();
    Eigen::Matrix3d R;
    R.col(1) = up.cross(Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0)).normalized();
    R.col(2) = up;
    R.col(0) = R.col(1).cross(up);
    Vector6 wobble = Vector6::Zero();
    wobble[3] = ride_.wobble_rad * std::sin(2.1 * t);
    wobble[4] = ride_.wobble_rad * std::sin(3.3 * t);
    return SE3(R, {p.x(), p.y(), z(p.x(), p.y())}) * SE3::exp(wobble);
  }

 private:
  static constexpr double kStep = 0.005;

  [[nodiscard]] Eigen::Vector2d slope(double phi) const {
    return (ride_.curve(phi + 1e-4) - ride_.curve(phi - 1e-4)) / 2e-4;
  }
  [[nodiscard]] double heading(double phi) const {
    const Eigen::Vector2d d = slope(phi);
    return std::atan2(d.y(), d.x());
  }
  [[nodiscard]] double target_rate(double phi, double t) const {
    if (t < ride_.rest_s) return 0.0;
    const double turn =
        std::abs(std::remainder(heading(phi + 1e-2) - heading(phi - 1e-2), 2 * 3.14159265358979)) / 2e-2;
    return std::min(ride_.max_speed / slope(phi).norm(), ride_.max_turn / std::max(turn, 1e-3));
  }
  /// Cubic (Catmull–Rom) through the table.
  [[nodiscard]] double parameter(double t) const {
    const double x = std::max(t, 0.0) / kStep;
    const auto i = std::min(static_cast<std::size_t>(x), phi_.size() - 3);
    const double f = x - static_cast<double>(i);
    const double a = i > 0 ? phi_[i - 1] : phi_[0], b = phi_[i], c = phi_[i + 1], d = phi_[i + 2];
    return b + 0.5 * f * (c - a + f * (2 * a - 5 * b + 4 * c - d + f * (3 * (b - c) + d - a)));
  }

  Ride ride_;
  std::vector<double> phi_;
};

}  // namespace cairn::support
