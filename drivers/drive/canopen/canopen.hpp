// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "drivers/drive/can/can_frame.hpp"
#include "hal/result.hpp"

/// CANopen's messages (CiA 301, version 4.2): 11-bit identifiers, numbers little-endian.
namespace cairn::drive::canopen {

/// Identifiers of the predefined connection set (CiA 301, 7.3.3); node identifiers 1 … 127 are added.
inline constexpr std::uint32_t kNmt = 0x000, kSync = 0x080, kEmergency = 0x080, kTpdo1 = 0x180, kRpdo1 = 0x200,
                               kTpdo2 = 0x280, kSdoResponse = 0x580, kSdoRequest = 0x600, kHeartbeat = 0x700;

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kPreOperational = 0x80,
  kResetNode = 0x81,
  kResetCommunication = 0x82,
};
/// The state in a heartbeat. kBootUp is the boot-up message (CiA 301, 7.2.8.3.3).
enum class NmtState : std::uint8_t { kBootUp = 0x00, kStopped = 0x04, kOperational = 0x05, kPreOperational = 0x7F };

/// An entry of the object dictionary.
struct Object {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  friend bool operator==(const Object&, const Object&) = default;
};

/// An emergency message (EMCY).
struct Emergency {
  std::uint16_t code = 0;  ///< 0: the last error is gone
  std::uint8_t error_register = 0;
  std::array<std::uint8_t, 5> vendor{};
};

/// A request for an entry of the object dictionary.
struct SdoRequest {
  enum class Kind : std::uint8_t { kRead, kWrite, kAbort };
  Kind kind{};
  Object object;
  std::uint32_t value = 0;  ///< written value, or abort code
  std::uint8_t bytes = 0;   ///< 1 … 4 of a write
};
/// The answer of a node to an SdoRequest.
struct SdoResponse {
  enum class Kind : std::uint8_t { kWritten, kValue, kAbort };
  Kind kind{};
  Object object;
  std::uint32_t value = 0;  ///< the value read (unsigned, little-endian), or the abort code
  std::uint8_t bytes = 0;   ///< 1 … 4 of a value

  /// The value sign-extended from `bytes`.
  [[nodiscard]] std::int32_t as_signed() const;
};

inline constexpr std::uint32_t kAbortTimeout = 0x05040000, kAbortCommand = 0x05040001, kAbortReadOnly = 0x06010002,
                               kAbortNoObject = 0x06020000, kAbortNoSubIndex = 0x06090011, kAbortState = 0x08000022,
                               kAbortValue = 0x06090030;
/// The text of an abort code (CiA 301, table 22), or "unknown abort code".
[[nodiscard]] std::string_view abort_text(std::uint32_t code);

/// A network management command to `node`; 0: to all nodes.
[[nodiscard]] CanFrame nmt(NmtCommand command, std::uint8_t node);
/// The message at which nodes send and take their synchronous PDOs.
[[nodiscard]] CanFrame sync();
/// The heartbeat of `node`.
[[nodiscard]] CanFrame heartbeat(std::uint8_t node, NmtState state);
/// An emergency message of `node`, for simulation.
[[nodiscard]] CanFrame emergency(std::uint8_t node, const Emergency& message);
/// Asks `node` for the value of an object.
[[nodiscard]] CanFrame sdo_read(std::uint8_t node, Object object);
/// Writes an object of `node` by an expedited transfer. `bytes` is 1 … 4.
[[nodiscard]] CanFrame sdo_write(std::uint8_t node, Object object, std::uint32_t value, std::uint8_t bytes);
/// Aborts a transfer with an abort code.
[[nodiscard]] CanFrame sdo_abort(std::uint8_t node, Object object, std::uint32_t code);
/// The answer of `node`, for simulation.
[[nodiscard]] CanFrame sdo_response(std::uint8_t node, const SdoResponse& response);

/// Decodes the payload of a heartbeat. Error: kMalformed (length or state).
[[nodiscard]] Result<NmtState> decode_heartbeat(const CanFrame& frame);
/// Decodes the payload of an emergency message. Error: kMalformed (length).
[[nodiscard]] Result<Emergency> decode_emergency(const CanFrame& frame);
/// Decodes an SDO request. Errors: kMalformed (length or command specifier), kUnsupported (segmented or block
/// transfer).
[[nodiscard]] Result<SdoRequest> decode_sdo_request(const CanFrame& frame);
/// Decodes an SDO response. Errors as decode_sdo_request().
[[nodiscard]] Result<SdoResponse> decode_sdo_response(const CanFrame& frame);

/// A little-endian number at byte `at` of the data. The caller has checked the length.
[[nodiscard]] std::uint16_t load_u16(const CanFrame& frame, std::size_t at);
/// A little-endian number at byte `at` of the data. The caller has checked the length.
[[nodiscard]] std::uint32_t load_u32(const CanFrame& frame, std::size_t at);
/// Writes the low `bytes` of `value` at byte `at` of the data, little-endian. The frame must be long enough.
void store(CanFrame& frame, std::size_t at, std::uint32_t value, std::size_t bytes);

}  // namespace cairn::drive::canopen
