// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/drive/canopen/canopen.hpp"
#include "drivers/drive/canopen/cia402.hpp"
#include "hal/time.hpp"
#include "tools/simulator/motor/object_dictionary.hpp"
#include "tools/simulator/motor/power_states.hpp"
#include "tools/simulator/motor/wheel_motor.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {

struct DriveModelConfig {
  std::uint8_t node = 1;
  std::uint32_t vendor = 0x300, product = 0x4644;
  double velocity_units_per_rad_s = 1000;
  double position_counts_per_rad = 10000;
  double encoder_noise_counts = 0;  ///< 1 σ of each reading
  int heartbeat_ms = 0;             ///< period of the heartbeat before anybody has set it; 0: silent
  double coasting_rad_s2 = 20;      ///< how fast a wheel without power comes to rest
  std::uint64_t seed = 1;
};

/// A CiA 402 motor controller with its motor and wheel, as seen from the bus: boot-up, NMT, SDO, PDO, SYNC, heartbeats
/// both ways, profile velocity with ramps, encoder, faults. Pure: frames and time in, frames out.
class DriveModel {
 public:
  using Frames = std::vector<drive::CanFrame>;

  explicit DriveModel(const DriveModelConfig& config);

  void power_on(Time now, Frames& out);
  void power_off() { powered_ = false; }
  void receive(const drive::CanFrame& frame, Time now, Frames& out);
  /// Moves the wheel and does what is due. Call it at least every few milliseconds.
  void step(Time now, Frames& out);

  /// Raises a fault of its own (CiA 402's error code); it lasts until reset, or for ever.
  void fail(std::uint16_t code, Frames& out, bool for_ever = false);
  /// Without SDO answers, heartbeats and PDOs, but still moving: a broken wire.
  void mute(bool muted) { muted_ = muted; }
  /// The wheel follows the world instead of the motor, for simulating a robot along a given path.
  void follow(double angle_rad, double speed_rad_s) { wheel_.follow(angle_rad, speed_rad_s); }

  [[nodiscard]] drive::cia402::State state() const { return power_.state(); }
  [[nodiscard]] drive::canopen::NmtState nmt() const { return nmt_; }
  [[nodiscard]] double angle() const { return wheel_.angle(); }  ///< of the wheel, rad
  [[nodiscard]] double speed() const { return wheel_.speed(); }  ///< rad/s
  /// 0 for an object that does not exist.
  [[nodiscard]] std::uint32_t object(drive::canopen::Object object) const { return objects_.value(object); }

 private:
  void boot(Time now, Frames& out);
  void command(drive::canopen::NmtCommand command, Time now, Frames& out);
  void answer(const drive::CanFrame& frame, Frames& out);
  void obey_if_written(drive::canopen::Object object);
  void move(double dt);
  void watch_host(Time now, Frames& out);
  [[nodiscard]] double ramp(drive::canopen::Object object) const;  // rad/s²
  void refresh();

  DriveModelConfig config_;
  Random random_;
  ObjectDictionary objects_;
  PowerStates power_;
  WheelMotor wheel_;
  bool powered_ = false, muted_ = false;
  drive::canopen::NmtState nmt_ = drive::canopen::NmtState::kBootUp;
  std::optional<Time> stepped_, host_heard_;
  Time heartbeat_at_{};
  double angle_at_boot_ = 0;
};

}  // namespace cairn::simulator
