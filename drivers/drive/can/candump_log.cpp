// SPDX-License-Identifier: Apache-2.0
// The form of candump -l: 123#1122, read and written.
#include <array>
#include <cstdio>

#include "drivers/drive/can/candump_text.hpp"

namespace cairn::drive {
namespace candump {
namespace {

constexpr std::string_view kDigits = "0123456789ABCDEF";

/// Bytes of two digits each, dots between them allowed, up to a space, an underscore or the end.
Result<void> parse_bytes(Cursor& line, std::size_t most, CanFrame& frame) {
  while (!line.done() && line.peek() != ' ' && line.peek() != '\t' && line.peek() != '_') {
    if (frame.length > 0) line.take('.');
    const auto byte = line.rest().size() < 2 ? std::nullopt : parse_hex(line.rest().substr(0, 2));
    if (!byte) return fault(line, "two hex digits make a byte");
    if (frame.length == most) return fault(line, "more data than a frame holds");
    frame.data[frame.length++] = static_cast<std::uint8_t>(*byte);
    line.advance(2);
  }
  return {};
}

Result<void> parse_fd(Cursor& line, CanFrame& frame) {
  const int flags = hex_digit(line.peek());
  if (flags < 0) return fault(line, "CAN FD flags are one hex digit");
  line.advance(1);
  frame.fd = true;
  frame.fd_flags = static_cast<std::uint8_t>(flags);
  if ((frame.id & kErrorFrame) != 0) return fault(line, "a CAN FD frame is no error frame");
  if (auto bytes = parse_bytes(line, 64, frame); !bytes) return bytes;
  if (!is_fd_length(frame.length)) return fault(line, "no length of a CAN FD frame");
  return {};
}

/// Behind the data of a classic frame of 8 bytes: _9 … _F.
Result<void> parse_raw_dlc(Cursor& line, CanFrame& frame) {
  if (!line.take('_')) return {};
  const int dlc = hex_digit(line.peek());
  if (frame.length != 8 || dlc <= 8) return fault(line, "a raw DLC is 9 … F, of a frame of 8 bytes");
  frame.raw_dlc = static_cast<std::uint8_t>(dlc);
  line.advance(1);
  return {};
}

Result<void> parse_classic(Cursor& line, CanFrame& frame) {
  if (line.take('R') || line.take('r')) {
    if (frame.error()) return fault(line, "an error frame is not remote");
    frame.id |= kRemote;
    if (const int length = hex_digit(line.peek()); length >= 0) {
      if (length > 8) return fault(line, "a remote frame asks for 8 bytes at most");
      frame.length = static_cast<std::uint8_t>(length);
      line.advance(1);
    }
  } else if (auto bytes = parse_bytes(line, 8, frame); !bytes) {
    return bytes;
  }
  return parse_raw_dlc(line, frame);
}

Result<void> parse_direction(Cursor& line, CandumpLine& out) {
  line.skip_space();
  if (line.done()) return {};
  if (line.take('R'))
    out.direction = Direction::kReceived;
  else if (line.take('T'))
    out.direction = Direction::kSent;
  line.skip_space();
  if (!line.done()) return fault(line, "only R or T may follow the frame");
  return {};
}

void append_hex(std::string& out, std::uint32_t value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += kDigits[value >> shift & 0xFU];
}

void append_id(std::string& out, const CanFrame& frame) {
  if (frame.error())
    append_hex(out, frame.id & (kErrorFrame | kExtendedMask), 8);
  else if ((frame.id & kExtended) != 0)
    append_hex(out, frame.id & kExtendedMask, 8);
  else
    append_hex(out, frame.id & kStandardMask, 3);
}

}  // namespace

Result<void> parse_log_frame(Cursor& line, CandumpLine& out) {
  const std::string_view id = line.advance(line.rest().find('#'));
  if (id.size() == 5) return Error{Errc::kUnsupported, "CAN XL frames are not supported", {}, line.column(), {}};
  const auto parsed = parse_id(id, line);
  if (!parsed) return parsed.error();
  out.frame.id = *parsed;
  line.take('#');
  auto frame = line.take('#') ? parse_fd(line, out.frame) : parse_classic(line, out.frame);
  if (!frame) return frame;
  return parse_direction(line, out);
}

}  // namespace candump

void append_candump(std::string& out, Time utc, std::string_view interface, const CanFrame& frame,
                    std::optional<Direction> direction) {
  const std::int64_t us = std::max<std::int64_t>(0, utc.time_since_epoch().count() / 1000);
  std::array<char, 40> stamp;
  const int size = std::snprintf(stamp.data(), stamp.size(), "(%010lld.%06lld) ",
                                 static_cast<long long>(us / 1'000'000), static_cast<long long>(us % 1'000'000));
  out.append(stamp.data(), static_cast<std::size_t>(size));
  out.append(interface).append(" ");
  candump::append_id(out, frame);
  out += '#';
  if (frame.fd) {
    out += '#';
    candump::append_hex(out, frame.fd_flags, 1);
  }
  if (frame.remote()) {
    out += 'R';
    if (frame.length > 0) candump::append_hex(out, frame.length, 1);
  } else {
    for (const std::uint8_t byte : frame.payload()) candump::append_hex(out, byte, 2);
  }
  if (frame.raw_dlc != 0) candump::append_hex(out += '_', frame.raw_dlc, 1);
  if (direction) out += *direction == Direction::kSent ? " T" : " R";
  out += '\n';
}

}  // namespace cairn::drive
