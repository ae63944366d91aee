// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drivers/drive/can/can_link.hpp"
#include "drivers/drive/chassis/config.hpp"
#include "drivers/drive/chassis/differential.hpp"
#include "tools/simulator/motion/drive_model.hpp"
#include "tools/simulator/motion/true_wheels.hpp"

namespace cairn::simulator {

/// The two motor controllers of a robot, on a CAN bus that somebody else commands. Their watchdogs, ramps and power
/// states are those of DriveModel.
class Motors {
 public:
  /// Frames, each way.
  struct Counters {
    std::uint64_t obeyed = 0, sent = 0;
    std::uint64_t unsent = 0;  ///< the bus, or a program on it, had no room for them
  };

  /// `bus` must outlive it. `measured`: the drive as its owner has configured it.
  Motors(drive::CanLink& bus, const drive::Config& measured, const WheelConfig& config, std::uint64_t seed);

  void power_on(Time now);
  /// A frame of the commanding computer. `now` is not before the last step().
  void obey(const drive::CanFrame& frame, Time now);
  /// Lets motors and wheels go on until `now`. Call it at least every few milliseconds.
  void step(Time now);

  /// How far the rims have rolled since the last call, in metres, forward.
  [[nodiscard]] drive::WheelSpeeds take_travel();
  [[nodiscard]] const TrueWheels& wheels() const { return wheels_; }
  [[nodiscard]] const std::vector<DriveModel>& nodes() const { return nodes_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  template <class Act>
  void each(Act&& act);

  drive::CanLink& bus_;
  WheelConfig config_;
  Random random_;
  TrueWheels wheels_;
  std::array<double, 2> sign_;     // −1: the motor counts backwards when the robot drives ahead
  std::vector<DriveModel> nodes_;  // left, right
  std::array<double, 2> taken_{};  // angles, rad
  Counters counters_;
};

}  // namespace cairn::simulator
