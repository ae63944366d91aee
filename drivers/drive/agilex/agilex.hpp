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

/// State 0x211: mode, battery and errors of the chassis.
struct SystemState {
  Vehicle vehicle{};
  Mode mode{};
  double battery_v = 0;
  std::uint16_t error = 0;   ///< bytes 4 (high) and 5; their meaning depends on the model
  std::uint8_t parking = 0;  ///< Hunter
  std::uint8_t count = 0;    ///< rolls over; a repeated value is a repeated frame
  friend bool operator==(const SystemState&, const SystemState&) = default;
};
/// Command 0x111 and state 0x221: a velocity of the chassis.
struct Motion {
  double v = 0;         ///< m/s
  double w = 0;         ///< rad/s
  double lateral = 0;   ///< m/s (omnidirectional models)
  double steering = 0;  ///< rad (Hunter: inner wheel)
  friend bool operator==(const Motion&, const Motion&) = default;
};
/// State 0x241: switches and sticks of the remote control.
struct RemoteControl {
  std::uint8_t switches = 0;  ///< two bits each for SWA … SWD: 2 up, 1 middle, 3 down
  std::array<std::int8_t, 4> sticks{};
  std::int8_t knob = 0;
  friend bool operator==(const RemoteControl&, const RemoteControl&) = default;
};
/// States 0x251 …: speed and current of one motor.
struct MotorFast {
  std::uint8_t motor = 0;  ///< 0 … 7
  std::int16_t rpm = 0;
  double current_a = 0;
  std::int32_t pulses = 0;  ///< wraps
  friend bool operator==(const MotorFast&, const MotorFast&) = default;
};
/// States 0x261 …: voltage, temperatures (°C) and faults of one motor.
struct MotorSlow {
  std::uint8_t motor = 0;
  double voltage_v = 0;
  std::int16_t driver_c = 0;
  std::int8_t motor_c = 0;
  std::uint8_t status = 0;  ///< bits: 0 under-voltage, 1 motor hot, 2 over-current, 3 driver hot, 4 CAN lost, 5 error
  friend bool operator==(const MotorSlow&, const MotorSlow&) = default;
};
/// State 0x311: the travel of both sides since power-on.
struct Odometer {
  std::int32_t left_mm = 0, right_mm = 0;  ///< wrap
  friend bool operator==(const Odometer&, const Odometer&) = default;
};
/// State 0x361: the battery's own report.
struct Battery {
  std::uint8_t charge_percent = 0, health_percent = 0;
  double voltage_v = 0, current_a = 0, temperature_c = 0;
  friend bool operator==(const Battery&, const Battery&) = default;
};
using Message = std::variant<SystemState, Motion, RemoteControl, MotorFast, MotorSlow, Odometer, Battery>;

/// Decodes a message of the chassis. Null: the frame is none of them. Error kMalformed: it does not have 8 bytes.
[[nodiscard]] Result<std::optional<Message>> decode(const CanFrame& frame);

/// The frame that the chassis would send, for simulation. decode(encode(m)) = m if the fields fit.
[[nodiscard]] CanFrame encode(const Message& message);

/// Command 0x111. Values beyond an i16 in mm/s or mrad saturate. The chassis stops 500 ms after the last command.
[[nodiscard]] CanFrame motion_command(const Motion& motion);
/// The motion that a frame 0x111 of 8 bytes commands.
[[nodiscard]] Motion read_motion(const CanFrame& frame);
/// Command 0x421: who may command the chassis.
[[nodiscard]] CanFrame control_mode(Mode mode);
/// Command 0x441: clears all errors.
[[nodiscard]] CanFrame clear_errors();
/// Command 0x131: locks or releases the parking brake.
[[nodiscard]] CanFrame brake(bool lock);

}  // namespace cairn::drive::agilex
