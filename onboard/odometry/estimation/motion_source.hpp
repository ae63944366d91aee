// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/odometry/estimation/motion_filter.hpp"

namespace cairn::odometry {

/// What every odometry tells besides its updates, whatever it looks at.
class MotionSource {
 public:
  MotionSource() = default;
  MotionSource(const MotionSource&) = delete;
  MotionSource& operator=(const MotionSource&) = delete;
  virtual ~MotionSource() = default;

  /// Pose and motion at the last measurement.
  [[nodiscard]] virtual const MotionFilter& motion() const = 0;
  /// How much acceleration is expected until the next measurement.
  [[nodiscard]] virtual MotionNoise expected_noise() const = 0;
};

}  // namespace cairn::odometry
