// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/cia402.hpp"

#include <array>

namespace cairn::drive::cia402 {
namespace {

using canopen::load_u16;
using canopen::load_u32;
using canopen::store;

CanFrame pdo(std::uint32_t id, std::uint8_t length) {
  CanFrame frame;
  frame.id = id;
  frame.length = length;
  return frame;
}

Error wrong_length(const CanFrame& frame) {
  return {Errc::kMalformed, "a PDO has another length than it was mapped to", {}, frame.length, {}};
}

}  // namespace

State state_of(std::uint16_t sw) {
  switch (sw & 0x4FU) {
    case 0x00:
      return State::kNotReadyToSwitchOn;
    case 0x40:
      return State::kSwitchOnDisabled;
    case 0x0F:
      return State::kFaultReactionActive;
    case 0x08:
      return State::kFault;
    default:
      break;
  }
  switch (sw & 0x6FU) {
    case 0x21:
      return State::kReadyToSwitchOn;
    case 0x23:
      return State::kSwitchedOn;
    case 0x27:
      return State::kOperationEnabled;
    case 0x07:
      return State::kQuickStopActive;
    default:
      return State::kUnknown;
  }
}

std::string_view to_string(State state) {
  constexpr std::array<std::string_view, 9> kNames{"not ready to switch on",
                                                   "switch-on disabled",
                                                   "ready to switch on",
                                                   "switched on",
                                                   "operation enabled",
                                                   "quick stop active",
                                                   "fault reaction",
                                                   "fault",
                                                   "unknown"};
  const auto i = static_cast<std::size_t>(state);
  return i < kNames.size() ? kNames[i] : kNames.back();
}

std::uint16_t towards_operation(State state) {
  switch (state) {
    case State::kSwitchOnDisabled:
      return kShutdown;
    case State::kReadyToSwitchOn:
      return kSwitchOn;
    case State::kSwitchedOn:
    case State::kOperationEnabled:
      return kEnableOperation;
    default:
      return kDisableVoltage;
  }
}

std::uint16_t towards_rest(State state) {
  return state == State::kOperationEnabled || state == State::kQuickStopActive ? kQuickStop : kDisableVoltage;
}

CanFrame rpdo1(std::uint8_t node, const WheelOrder& order) {
  CanFrame frame = pdo(canopen::kRpdo1 + node, kOrderBytes);
  store(frame, 0, order.controlword, 2);
  store(frame, 2, static_cast<std::uint32_t>(order.target_velocity), 4);
  return frame;
}
Result<WheelOrder> decode_rpdo1(const CanFrame& frame) {
  if (frame.length != kOrderBytes) return wrong_length(frame);
  return WheelOrder{load_u16(frame, 0), static_cast<std::int32_t>(load_u32(frame, 2))};
}

CanFrame tpdo1(std::uint8_t node, const Status& status) {
  CanFrame frame = pdo(canopen::kTpdo1 + node, kStatusBytes);
  store(frame, 0, status.statusword, 2);
  store(frame, 2, static_cast<std::uint8_t>(status.mode), 1);
  store(frame, 3, status.error_code, 2);
  return frame;
}
Result<Status> decode_tpdo1(const CanFrame& frame) {
  if (frame.length != kStatusBytes) return wrong_length(frame);
  return Status{load_u16(frame, 0), static_cast<std::int8_t>(frame.data[2]), load_u16(frame, 3)};
}

CanFrame tpdo2(std::uint8_t node, const Motion& motion) {
  CanFrame frame = pdo(canopen::kTpdo2 + node, kMotionBytes);
  store(frame, 0, static_cast<std::uint32_t>(motion.position), 4);
  store(frame, 4, static_cast<std::uint32_t>(motion.velocity), 4);
  return frame;
}
Result<Motion> decode_tpdo2(const CanFrame& frame) {
  if (frame.length != kMotionBytes) return wrong_length(frame);
  return Motion{static_cast<std::int32_t>(load_u32(frame, 0)), static_cast<std::int32_t>(load_u32(frame, 4))};
}

}  // namespace cairn::drive::cia402
