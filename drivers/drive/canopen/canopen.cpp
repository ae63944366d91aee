// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/canopen.hpp"

#include <algorithm>

namespace cairn::drive::canopen {
namespace {

CanFrame eight(std::uint32_t id) {
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  return frame;
}

CanFrame sdo(std::uint32_t id, std::uint8_t command, Object object, std::uint32_t value) {
  CanFrame frame = eight(id);
  frame.data[0] = command;
  store(frame, 1, object.index, 2);
  frame.data[3] = object.sub;
  store(frame, 4, value, 4);
  return frame;
}

Object object_in(const CanFrame& frame) { return {load_u16(frame, 1), frame.data[3]}; }

/// Bytes of data that an expedited command specifier announces (bits 3-2: unused bytes; bit 0: they are announced).
std::uint8_t expedited_bytes(std::uint8_t command) {
  return static_cast<std::uint8_t>((command & 1U) != 0 ? 4U - (command >> 2U & 3U) : 4U);
}
std::uint32_t low_bytes(std::uint32_t value, std::uint8_t bytes) {
  return bytes >= 4 ? value : value & ((1U << 8U * bytes) - 1U);
}
constexpr std::uint8_t kExpedited = 0x02, kAbort = 0x80;

}  // namespace

std::int32_t SdoResponse::as_signed() const {
  const unsigned shift = 32U - 8U * std::clamp<unsigned>(bytes, 1, 4);
  return static_cast<std::int32_t>(value << shift) >> shift;
}

std::string_view abort_text(std::uint32_t code) {
  struct Text {
    std::uint32_t code;
    std::string_view text;
  };
  constexpr std::array kTexts{
      Text{0x05030000, "toggle bit not alternated"},
      Text{kAbortTimeout, "no answer in time"},
      Text{kAbortCommand, "command specifier not valid or unknown"},
      Text{0x06010000, "unsupported access"},
      Text{0x06010001, "read of a write-only object"},
      Text{kAbortReadOnly, "write to a read-only object"},
      Text{kAbortNoObject, "object does not exist"},
      Text{0x06040041, "object cannot be mapped to a PDO"},
      Text{0x06040042, "mapped objects exceed the PDO's length"},
      Text{0x06040043, "parameters are incompatible"},
      Text{0x06060000, "hardware error"},
      Text{0x06070010, "length of the parameter does not match"},
      Text{kAbortNoSubIndex, "sub-index does not exist"},
      Text{kAbortValue, "value out of range"},
      Text{0x06090031, "value too high"},
      Text{0x06090032, "value too low"},
      Text{0x08000000, "general error"},
      Text{0x08000020, "data cannot be stored"},
      Text{0x08000021, "data cannot be stored because of local control"},
      Text{kAbortState, "data cannot be stored in the present state"},
  };
  const auto found = std::find_if(kTexts.begin(), kTexts.end(), [&](const Text& t) { return t.code == code; });
  return found == kTexts.end() ? "unknown abort code" : found->text;
}

CanFrame nmt(NmtCommand command, std::uint8_t node) {
  return make_frame(kNmt, {static_cast<std::uint8_t>(command), node});
}
CanFrame sync() { return make_frame(kSync, {}); }
CanFrame heartbeat(std::uint8_t node, NmtState state) {
  return make_frame(kHeartbeat + node, {static_cast<std::uint8_t>(state)});
}

CanFrame emergency(std::uint8_t node, const Emergency& message) {
  CanFrame frame = eight(kEmergency + node);
  store(frame, 0, message.code, 2);
  frame.data[2] = message.error_register;
  std::copy(message.vendor.begin(), message.vendor.end(), frame.data.begin() + 3);
  return frame;
}

CanFrame sdo_read(std::uint8_t node, Object object) { return sdo(kSdoRequest + node, 0x40, object, 0); }

CanFrame sdo_write(std::uint8_t node, Object object, std::uint32_t value, std::uint8_t bytes) {
  const auto command = static_cast<std::uint8_t>(0x23U | (4U - std::clamp<unsigned>(bytes, 1, 4)) << 2U);
  return sdo(kSdoRequest + node, command, object, low_bytes(value, bytes));
}

CanFrame sdo_abort(std::uint8_t node, Object object, std::uint32_t code) {
  return sdo(kSdoRequest + node, kAbort, object, code);
}

CanFrame sdo_response(std::uint8_t node, const SdoResponse& r) {
  if (r.kind == SdoResponse::Kind::kWritten) return sdo(kSdoResponse + node, 0x60, r.object, 0);
  if (r.kind == SdoResponse::Kind::kAbort) return sdo(kSdoResponse + node, kAbort, r.object, r.value);
  const auto command = static_cast<std::uint8_t>(0x43U | (4U - std::clamp<unsigned>(r.bytes, 1, 4)) << 2U);
  return sdo(kSdoResponse + node, command, r.object, low_bytes(r.value, r.bytes));
}

Result<NmtState> decode_heartbeat(const CanFrame& frame) {
  if (frame.length != 1) return Error{Errc::kMalformed, "a heartbeat has 1 byte", {}, frame.length, {}};
  const auto state = static_cast<NmtState>(frame.data[0] & 0x7FU);  // bit 7 toggles in node guarding
  if (state == NmtState::kBootUp || state == NmtState::kStopped || state == NmtState::kOperational ||
      state == NmtState::kPreOperational)
    return state;
  return Error{Errc::kMalformed, "a heartbeat tells no known state", {}, 0, {}};
}

Result<Emergency> decode_emergency(const CanFrame& frame) {
  if (frame.length != 8) return Error{Errc::kMalformed, "an emergency message has 8 bytes", {}, frame.length, {}};
  Emergency message{load_u16(frame, 0), frame.data[2], {}};
  std::copy_n(frame.data.begin() + 3, 5, message.vendor.begin());
  return message;
}

Result<SdoRequest> decode_sdo_request(const CanFrame& frame) {
  if (frame.length != 8) return Error{Errc::kMalformed, "an SDO message has 8 bytes", {}, frame.length, {}};
  const std::uint8_t command = frame.data[0];
  SdoRequest request{SdoRequest::Kind::kRead, object_in(frame), 0, 0};
  if (command == 0x40) return request;
  request.value = load_u32(frame, 4);
  if (command == kAbort) return request.kind = SdoRequest::Kind::kAbort, request;
  if (command >> 5U != 1 || (command & kExpedited) == 0)
    return Error{Errc::kUnsupported, "only expedited SDO transfer is supported", {}, 0, {}};
  request.kind = SdoRequest::Kind::kWrite;
  request.bytes = expedited_bytes(command);
  request.value = low_bytes(request.value, request.bytes);
  return request;
}

Result<SdoResponse> decode_sdo_response(const CanFrame& frame) {
  if (frame.length != 8) return Error{Errc::kMalformed, "an SDO message has 8 bytes", {}, frame.length, {}};
  const std::uint8_t command = frame.data[0];
  SdoResponse response{SdoResponse::Kind::kWritten, object_in(frame), 0, 0};
  if (command == 0x60) return response;
  response.value = load_u32(frame, 4);
  if (command == kAbort) return response.kind = SdoResponse::Kind::kAbort, response;
  if (command >> 5U != 2 || (command & kExpedited) == 0)
    return Error{Errc::kUnsupported, "only expedited SDO transfer is supported", {}, 0, {}};
  response.kind = SdoResponse::Kind::kValue;
  response.bytes = expedited_bytes(command);
  response.value = low_bytes(response.value, response.bytes);
  return response;
}

std::uint16_t load_u16(const CanFrame& f, std::size_t at) {
  return static_cast<std::uint16_t>(f.data[at] | f.data[at + 1] << 8U);
}
std::uint32_t load_u32(const CanFrame& f, std::size_t at) {
  return static_cast<std::uint32_t>(load_u16(f, at)) | static_cast<std::uint32_t>(load_u16(f, at + 2)) << 16U;
}
void store(CanFrame& f, std::size_t at, std::uint32_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) f.data[at + i] = static_cast<std::uint8_t>(value >> 8U * i);
}

}  // namespace cairn::drive::canopen
