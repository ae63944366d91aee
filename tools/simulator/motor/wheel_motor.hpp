// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace cairn::simulator {

/// A wheel and the motor that turns it: a speed that follows its goal at a bounded rate. Pure.
class WheelMotor {
 public:
  /// For `dt` seconds: towards `goal` rad/s, by at most `rate` rad/s².
  void move(double goal, double rate, double dt) {
    const double before = speed_;
    speed_ += std::clamp(goal - speed_, -rate * dt, rate * dt);
    angle_ += (before + speed_) / 2 * dt;
  }
  /// From now on the wheel follows the world instead of the motor.
  void follow(double angle_rad, double speed_rad_s) {
    followed_ = true;
    angle_ = angle_rad;
    speed_ = speed_rad_s;
  }

  [[nodiscard]] double angle() const { return angle_; }  ///< rad
  [[nodiscard]] double speed() const { return speed_; }  ///< rad/s
  [[nodiscard]] bool followed() const { return followed_; }

 private:
  double angle_ = 0, speed_ = 0;
  bool followed_ = false;
};

}  // namespace cairn::simulator
