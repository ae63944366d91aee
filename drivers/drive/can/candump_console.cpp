// SPDX-License-Identifier: Apache-2.0
// The form that candump prints on a console: 123   [2]  11 22
#include <algorithm>

#include "drivers/drive/can/candump_text.hpp"

namespace cairn::drive::candump {
namespace {

/// RX or TX and the two flags of -x: bit rate switch (B) and error state (E), or dashes.
Result<void> parse_extra(Cursor& line, CandumpLine& out) {
  if (line.take("RX "))
    out.direction = Direction::kReceived;
  else if (line.take("TX "))
    out.direction = Direction::kSent;
  else
    return {};
  line.skip_space();
  if (line.take('B'))
    out.frame.fd_flags |= kFdBitRateSwitch;
  else if (!line.take('-'))
    return fault(line, "B or - expected");
  line.skip_space();
  if (line.take('E'))
    out.frame.fd_flags |= kFdErrorState;
  else if (!line.take('-'))
    return fault(line, "E or - expected");
  line.skip_space();
  return {};
}

/// [8], or [08] of an FD frame, or {F}, the raw DLC of a frame of 8 bytes.
Result<void> parse_length(Cursor& line, CanFrame& frame) {
  if (line.take('{')) {
    const int dlc = hex_digit(line.peek());
    line.advance(1);
    if (dlc <= 8 || !line.take('}')) return fault(line, "a raw DLC is 9 … F");
    frame.length = 8;
    frame.raw_dlc = static_cast<std::uint8_t>(dlc);
    return {};
  }
  if (!line.take('[')) return fault(line, "[length] expected");
  std::size_t digits = 0, length = 0;
  for (; digits < 2 && line.peek() >= '0' && line.peek() <= '9'; ++digits)
    length = length * 10 + static_cast<std::size_t>(line.advance(1)[0] - '0');
  if (digits == 0 || !line.take(']')) return fault(line, "[length] expected");
  frame.fd = digits == 2;
  if (frame.fd ? !is_fd_length(length) : length > 8) return fault(line, "no length of a CAN frame");
  if (frame.fd && frame.error()) return fault(line, "a CAN FD frame is no error frame");
  frame.length = static_cast<std::uint8_t>(length);
  return {};
}

/// Two hex digits, or eight binary ones (-i).
std::optional<std::uint8_t> parse_byte(std::string_view digits) {
  if (digits.size() == 2) {
    const auto value = parse_hex(digits);
    return value ? std::optional(static_cast<std::uint8_t>(*value)) : std::nullopt;
  }
  if (digits.size() != 8 || digits.find_first_not_of("01") != std::string_view::npos) return std::nullopt;
  unsigned value = 0;
  for (const char c : digits) value = value << 1U | static_cast<unsigned>(c - '0');
  return static_cast<std::uint8_t>(value);
}

/// `length` bytes between spaces; with -S they stand in reverse order with ` between them.
Result<void> parse_bytes(Cursor& line, CanFrame& frame) {
  bool swapped = false;
  for (std::size_t i = 0; i < frame.length; ++i) {
    line.skip_space();
    if (line.take('`')) swapped = true;
    const auto byte = parse_byte(line.rest().substr(0, line.rest().find_first_of(" \t`")));
    if (!byte) return fault(line, "fewer bytes than [length] says, or no byte");
    frame.data[i] = *byte;
    line.advance(std::min(line.rest().find_first_of(" \t`"), line.rest().size()));
  }
  if (swapped) std::reverse(frame.data.begin(), frame.data.begin() + frame.length);
  return {};
}

}  // namespace

Result<void> parse_console_frame(Cursor& line, CandumpLine& out) {
  if (auto extra = parse_extra(line, out); !extra) return extra;
  const auto id = parse_id(line.word(), line);
  if (!id) return id.error();
  out.frame.id = *id;
  line.skip_space();
  if (auto length = parse_length(line, out.frame); !length) return length;
  line.skip_space();
  if (line.take("remote request")) {
    if (out.frame.error() || out.frame.fd) return fault(line, "this frame cannot be remote");
    out.frame.id |= kRemote;
  } else if (auto bytes = parse_bytes(line, out.frame); !bytes) {
    return bytes;
  }
  if (!out.frame.fd) out.frame.fd_flags = 0;
  line.skip_space();
  const bool text = line.peek() == '\'' || line.peek() == '`';  // -a
  if (!line.done() && !text && !line.take("ERRORFRAME")) return fault(line, "more bytes than [length] says");
  return {};
}

}  // namespace cairn::drive::candump
