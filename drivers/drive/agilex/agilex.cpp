// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/agilex/agilex.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::drive::agilex {
namespace {

std::uint16_t u16(const CanFrame& f, std::size_t at) {
  return static_cast<std::uint16_t>(f.data[at] << 8U | f.data[at + 1]);
}
std::int16_t i16(const CanFrame& f, std::size_t at) { return static_cast<std::int16_t>(u16(f, at)); }
std::int32_t i32(const CanFrame& f, std::size_t at) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(u16(f, at)) << 16U | u16(f, at + 2));
}
void put16(CanFrame& f, std::size_t at, std::uint32_t value) {
  f.data[at] = static_cast<std::uint8_t>(value >> 8U);
  f.data[at + 1] = static_cast<std::uint8_t>(value);
}
void put32(CanFrame& f, std::size_t at, std::int32_t value) {
  put16(f, at, static_cast<std::uint32_t>(value) >> 16U);
  put16(f, at + 2, static_cast<std::uint32_t>(value));
}
/// value / unit as an i16, saturated.
std::uint32_t scaled(double value, double unit) {
  const double steps = std::clamp(std::round(value / unit), -32768.0, 32767.0);
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(steps));
}
/// value / unit as a u16, saturated.
std::uint32_t scaled_unsigned(double value, double unit) {
  return static_cast<std::uint32_t>(std::clamp(std::round(value / unit), 0.0, 65535.0));
}
CanFrame eight(std::uint32_t id) {
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  return frame;
}

// The wire counts in thousandths and tenths: dividing keeps the decimal number's nearest double.
SystemState system_state(const CanFrame& f) {
  return {
      static_cast<Vehicle>(f.data[0]), static_cast<Mode>(f.data[1]), u16(f, 2) / 10.0, u16(f, 4), f.data[6], f.data[7]};
}
RemoteControl remote_control(const CanFrame& f) {
  RemoteControl rc{f.data[0], {}, static_cast<std::int8_t>(f.data[5])};
  for (std::size_t i = 0; i < 4; ++i) rc.sticks[i] = static_cast<std::int8_t>(f.data[i + 1]);
  return rc;
}

struct Encoder {
  CanFrame operator()(const SystemState& m) const {
    CanFrame f = eight(kSystemStateId);
    f.data[0] = static_cast<std::uint8_t>(m.vehicle);
    f.data[1] = static_cast<std::uint8_t>(m.mode);
    put16(f, 2, scaled_unsigned(m.battery_v, 0.1));
    put16(f, 4, m.error);
    f.data[6] = m.parking;
    f.data[7] = m.count;
    return f;
  }
  CanFrame operator()(const Motion& m) const {
    CanFrame f = motion_command(m);
    f.id = kMotionStateId;
    return f;
  }
  CanFrame operator()(const RemoteControl& m) const {
    CanFrame f = eight(kRemoteControlId);
    f.data[0] = m.switches;
    for (std::size_t i = 0; i < 4; ++i) f.data[i + 1] = static_cast<std::uint8_t>(m.sticks[i]);
    f.data[5] = static_cast<std::uint8_t>(m.knob);
    return f;
  }
  CanFrame operator()(const MotorFast& m) const {
    CanFrame f = eight(kMotorFastId + m.motor % kMotors);
    put16(f, 0, static_cast<std::uint16_t>(m.rpm));
    put16(f, 2, scaled(m.current_a, 0.1));
    put32(f, 4, m.pulses);
    return f;
  }
  CanFrame operator()(const MotorSlow& m) const {
    CanFrame f = eight(kMotorSlowId + m.motor % kMotors);
    put16(f, 0, scaled_unsigned(m.voltage_v, 0.1));
    put16(f, 2, static_cast<std::uint16_t>(m.driver_c));
    f.data[4] = static_cast<std::uint8_t>(m.motor_c);
    f.data[5] = m.status;
    return f;
  }
  CanFrame operator()(const Odometer& m) const {
    CanFrame f = eight(kOdometerId);
    put32(f, 0, m.left_mm);
    put32(f, 4, m.right_mm);
    return f;
  }
  CanFrame operator()(const Battery& m) const {
    CanFrame f = eight(kBatteryId);
    f.data[0] = m.charge_percent;
    f.data[1] = m.health_percent;
    put16(f, 2, scaled_unsigned(m.voltage_v, 0.1));
    put16(f, 4, scaled(m.current_a, 0.1));
    put16(f, 6, scaled(m.temperature_c, 0.1));
    return f;
  }
};

Message message(const CanFrame& f) {
  const auto motor = static_cast<std::uint8_t>((f.id & 0xFU) - 1);
  switch (f.id) {
    case kSystemStateId:
      return system_state(f);
    case kMotionStateId:
      return read_motion(f);
    case kRemoteControlId:
      return remote_control(f);
    case kOdometerId:
      return Odometer{i32(f, 0), i32(f, 4)};
    case kBatteryId:
      return Battery{f.data[0], f.data[1], u16(f, 2) / 10.0, i16(f, 4) / 10.0, i16(f, 6) / 10.0};
    default:
      break;
  }
  if (f.id >= kMotorSlowId)
    return MotorSlow{motor, u16(f, 0) / 10.0, i16(f, 2), static_cast<std::int8_t>(f.data[4]), f.data[5]};
  return MotorFast{motor, i16(f, 0), i16(f, 2) / 10.0, i32(f, 4)};
}

bool known(std::uint32_t id) {
  const bool motor =
      (id >= kMotorFastId && id < kMotorFastId + kMotors) || (id >= kMotorSlowId && id < kMotorSlowId + kMotors);
  return motor || id == kSystemStateId || id == kMotionStateId || id == kRemoteControlId || id == kOdometerId ||
         id == kBatteryId;
}

}  // namespace

Result<std::optional<Message>> decode(const CanFrame& frame) {
  if (frame.fd || !known(frame.id)) return std::optional<Message>();
  if (frame.length != 8) return Error{Errc::kMalformed, "a message of AgileX has 8 bytes", {}, frame.length, {}};
  return std::optional(message(frame));
}

CanFrame encode(const Message& message) { return std::visit(Encoder{}, message); }

CanFrame motion_command(const Motion& m) {
  CanFrame f = eight(kMotionCommandId);
  put16(f, 0, scaled(m.v, 0.001));
  put16(f, 2, scaled(m.w, 0.001));
  put16(f, 4, scaled(m.lateral, 0.001));
  put16(f, 6, scaled(m.steering, 0.001));
  return f;
}

Motion read_motion(const CanFrame& f) {
  return {
      .v = i16(f, 0) / 1000.0, .w = i16(f, 2) / 1000.0, .lateral = i16(f, 4) / 1000.0, .steering = i16(f, 6) / 1000.0};
}

CanFrame control_mode(Mode mode) { return make_frame(kControlModeId, {static_cast<std::uint8_t>(mode)}); }
CanFrame clear_errors() { return make_frame(kClearErrorId, {0}); }
CanFrame brake(bool lock) { return make_frame(kBrakeId, {static_cast<std::uint8_t>(lock ? 1 : 0)}); }

}  // namespace cairn::drive::agilex
