// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "drivers/drive/can/can_frame.hpp"
#include "hal/result.hpp"

/// AgileX' CAN protocol, version 2 (Scout, Hunter, Bunker, Tracer, Ranger): standard identifiers, 500 kbit/s, 8 bytes,
/// numbers big-endian. Source: "SCOUT user manual" 1.3.0 and "Hunter 2.0 CAN" 2.1.
namespace cairn::drive::agilex {

inline constexpr std::uint32_t kMotionCommandId = 0x111, kBrakeId = 0x131, kSystemStateId = 0x211,
                               kMotionStateId = 0x221, kRemoteControlId = 0x241, kMotorFastId = 0x251,
                               kMotorSlowId = 0x261, kOdometerId = 0x311, kBatteryId = 0x361, kControlModeId = 0x421,
                               kClearErrorId = 0x441;
inline constexpr int kMotors = 8;  ///< identifiers kMotorFastId … +7, kMotorSlowId … +7

enum class Vehicle : std::uint8_t { kNormal = 0, kEmergencyStop = 1, kException = 2 };
enum class Mode : std::uint8_t { kStandby = 0, kCan = 1, kUart = 2, kRemoteControl = 3 };

struct SystemState {
  Vehicle vehicle{};
  Mode mode{};
  double battery_v = 0;
  std::uint16_t error = 0;   ///< bytes 4 (high) and 5; their meaning depends on the model
  std::uint8_t parking = 0;  ///< Hunter
  std::uint8_t count = 0;    ///< rolls over; a repeated value is a repeated frame
  friend bool operator==(const SystemState&, const SystemState&) = default;
};
/// Of command 0x111 and state 0x221.
struct Motion {
  double v = 0;         ///< m/s
  double w = 0;         ///< rad/s
  double lateral = 0;   ///< m/s (omnidirectional models)
  double steering = 0;  ///< rad (Hunter: inner wheel)
  friend bool operator==(const Motion&, const Motion&) = default;
};
struct RemoteControl {
  std::uint8_t switches = 0;  ///< two bits each for SWA … SWD: 2 up, 1 middle, 3 down
  std::array<std::int8_t, 4> sticks{};
  std::int8_t knob = 0;
  friend bool operator==(const RemoteControl&, const RemoteControl&) = default;
};
struct MotorFast {
  std::uint8_t motor = 0;  ///< 0 … 7
  std::int16_t rpm = 0;
  double current_a = 0;
  std::int32_t pulses = 0;  ///< wraps
  friend bool operator==(const MotorFast&, const MotorFast&) = default;
};
struct MotorSlow {
  std::uint8_t motor = 0;
  double voltage_v = 0;
  std::int16_t driver_c = 0;
  std::int8_t motor_c = 0;
  std::uint8_t status = 0;  ///< bits: 0 under-voltage, 1 motor hot, 2 over-current, 3 driver hot, 4 CAN lost, 5 error
  friend bool operator==(const MotorSlow&, const MotorSlow&) = default;
};
struct Odometer {
  std::int32_t left_mm = 0, right_mm = 0;  ///< wrap
  friend bool operator==(const Odometer&, const Odometer&) = default;
};
struct Battery {
  std::uint8_t charge_percent = 0, health_percent = 0;
  double voltage_v = 0, current_a = 0, temperature_c = 0;
  friend bool operator==(const Battery&, const Battery&) = default;
};
using Message = std::variant<SystemState, Motion, RemoteControl, MotorFast, MotorSlow, Odometer, Battery>;

/// A message of the chassis. Null: a frame that is none of them. Error kMalformed: it has not 8 bytes.
[[nodiscard]] Result<std::optional<Message>> decode(const CanFrame& frame);

/// The chassis' side, for simulation: decode(encode(m)) = m where the fields fit.
[[nodiscard]] CanFrame encode(const Message& message);

/// Command 0x111; values beyond an i16 in mm/s or mrad saturate. The chassis stops 500 ms after the last one.
[[nodiscard]] CanFrame motion_command(const Motion& motion);
/// The motion that a frame 0x111 of 8 bytes commands.
[[nodiscard]] Motion read_motion(const CanFrame& frame);
[[nodiscard]] CanFrame control_mode(Mode mode);
[[nodiscard]] CanFrame clear_errors();
[[nodiscard]] CanFrame brake(bool lock);

}  // namespace cairn::drive::agilex
