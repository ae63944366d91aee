// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "drivers/drive/can_drive.hpp"
#include "tools/simulator/motion/drive_model.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/motion/true_wheels.hpp"

namespace cairn::simulator {

/// What the drive of the simulated Husky is told; the same keys decode the recording.
[[nodiscard]] drive::Config husky_drive();

/// The CAN bus of a robot that drives a known trajectory: two simulated CiA 402 motor controllers whose wheels turn
/// with the ground (and slip), and this project's own master, which configures, arms and commands them. All frames,
/// both ways, as a controller that confirms what it sends sees them.
class MotorBus final : public drive::CanLink {
 public:
  static constexpr Duration kTick = std::chrono::milliseconds(5);
  /// The drive is powered so long before the trajectory starts.
  static constexpr Duration kPowerOn = std::chrono::milliseconds(1500);

  /// `trajectory` must outlive it.
  MotorBus(const WheelConfig& config, const Trajectory& trajectory, std::uint64_t seed);

  /// The next kTick of bus time; `armable` is whether the e-stop allows it. Frames of the tick are in frames() until
  /// the next one.
  void tick(bool armable);
  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] const std::vector<Packet>& frames() const { return frames_; }
  [[nodiscard]] DriveLevel level() const { return drive_->status().level; }
  [[nodiscard]] int spins() const { return spins_; }

  Result<Poll> next(Packet& packet, Duration timeout) override;
  drive::SendResult send(const drive::CanFrame& frame) override;
  Result<void> restart() override { return {}; }

 private:
  void turn_wheels();
  void carry(const drive::CanFrame& frame, drive::Direction direction);

  WheelConfig config_;
  const Trajectory& trajectory_;
  Random random_;
  Time now_;
  Time free_{};  // when the wire is free again
  drive::Config drive_config_;
  TrueWheels wheels_;
  double angle_[2] = {0, 0};
  Time spin_until_{}, next_spin_;
  std::size_t spinning_ = 0;
  int spins_ = 0;
  std::uint32_t epoch_ = 0;
  std::vector<DriveModel> nodes_;
  std::unique_ptr<drive::CanDrive> drive_;
  std::deque<Packet> inbox_;
  std::vector<Packet> frames_;
  std::uint64_t sequence_ = 0;
};

}  // namespace cairn::simulator
