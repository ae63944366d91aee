// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "drivers/drive/canopen/canopen.hpp"

/// The device profile for drives (CiA 402-2, IEC 61800-7-201): objects, power state machine, velocity modes.
namespace cairn::drive::cia402 {

using canopen::Object;

inline constexpr Object kDeviceType{0x1000, 0}, kConsumerHeartbeat{0x1016, 1}, kProducerHeartbeat{0x1017, 0},
    kVendor{0x1018, 1}, kProduct{0x1018, 2}, kAbortConnection{0x6007, 0}, kErrorCode{0x603F, 0},
    kControlword{0x6040, 0}, kStatusword{0x6041, 0}, kQuickStopOption{0x605A, 0}, kMode{0x6060, 0},
    kModeDisplay{0x6061, 0}, kPosition{0x6064, 0}, kVelocity{0x606C, 0}, kAcceleration{0x6083, 0},
    kDeceleration{0x6084, 0}, kQuickStopDeceleration{0x6085, 0}, kTargetVelocity{0x60FF, 0};

inline constexpr std::uint32_t kProfile = 0x0192;    ///< low half of the device type
inline constexpr std::int8_t kProfileVelocity = 3;   ///< mode of operation
inline constexpr std::uint16_t kReactQuickStop = 3;  ///< of kAbortConnection: what the drive does when the host is gone
inline constexpr std::uint16_t kRampThenDisable = 2;  ///< of kQuickStopOption

/// States of the power state machine (CiA 402-2, table 30).
enum class State : std::uint8_t {
  kNotReadyToSwitchOn,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
  kUnknown,
};
/// The state in a statusword (object 6041); kUnknown for a pattern that the table does not have.
[[nodiscard]] State state_of(std::uint16_t statusword);
/// A name for messages.
[[nodiscard]] std::string_view to_string(State state);

/// Controlwords (CiA 402-2, table 28).
inline constexpr std::uint16_t kDisableVoltage = 0x00, kQuickStop = 0x02, kShutdown = 0x06, kSwitchOn = 0x07,
                               kEnableOperation = 0x0F, kFaultReset = 0x80, kHalt = 0x100;

/// The controlword that takes a motor controller one step towards operation. In a fault it is kDisableVoltage: the
/// change from it to kFaultReset resets the fault.
[[nodiscard]] std::uint16_t towards_operation(State state);
/// The controlword that stops: quick stop while the drive is in operation, then disable voltage.
[[nodiscard]] std::uint16_t towards_rest(State state);

/// RPDO1 as this master maps it (6040, 60FF). It carries a whole order, so that stopping takes one frame.
struct WheelOrder {
  std::uint16_t controlword = kDisableVoltage;
  std::int32_t target_velocity = 0;  ///< drive units
  friend bool operator==(const WheelOrder&, const WheelOrder&) = default;
};
inline constexpr std::uint8_t kOrderBytes = 6;
/// RPDO1 to `node`.
[[nodiscard]] CanFrame rpdo1(std::uint8_t node, const WheelOrder& order);
/// The inverse, for simulation. Error: kMalformed (length).
[[nodiscard]] Result<WheelOrder> decode_rpdo1(const CanFrame& frame);

/// TPDO1 (6041, 6061, 603F), sent on SYNC.
struct Status {
  std::uint16_t statusword = 0;
  std::int8_t mode = 0;
  std::uint16_t error_code = 0;
  friend bool operator==(const Status&, const Status&) = default;
};
inline constexpr std::uint8_t kStatusBytes = 5;
/// TPDO1 of `node`, for simulation.
[[nodiscard]] CanFrame tpdo1(std::uint8_t node, const Status& status);
/// Error: kMalformed (length).
[[nodiscard]] Result<Status> decode_tpdo1(const CanFrame& frame);

/// TPDO2 (6064, 606C), sent on SYNC.
struct Motion {
  std::int32_t position = 0;  ///< encoder counts; wraps
  std::int32_t velocity = 0;  ///< drive units
  friend bool operator==(const Motion&, const Motion&) = default;
};
inline constexpr std::uint8_t kMotionBytes = 8;
/// TPDO2 of `node`, for simulation.
[[nodiscard]] CanFrame tpdo2(std::uint8_t node, const Motion& motion);
/// Error: kMalformed (length).
[[nodiscard]] Result<Motion> decode_tpdo2(const CanFrame& frame);

}  // namespace cairn::drive::cia402
