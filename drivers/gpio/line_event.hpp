// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/packet.hpp"
#include "hal/result.hpp"

namespace cairn::gpio {

/// Packet::channel of a line's events.
enum class Line : std::uint16_t { kEStop = 0, kTrigger = 1, kPps = 2 };
inline constexpr std::size_t kLines = 3;
/// The name of the line in gpio.csv.
[[nodiscard]] std::string_view name_of(Line line);
/// The inverse; null for another name.
[[nodiscard]] std::optional<Line> line_named(std::string_view name);

/// An edge, or a level that was read. Its time is Packet::arrival.
struct LineEvent {
  Line line{};
  bool level = false;          ///< logical level afterwards; true of an e-stop means closed
  bool sampled = false;        ///< the level was read; it is not an edge
  std::uint32_t sequence = 0;  ///< the kernel's count of the line's edges, from 1; 0: not known
  friend bool operator==(const LineEvent&, const LineEvent&) = default;
};

/// Bytes of its Packet: 0 u8 level · 1 u8 sampled · 2 u16 zero · 4 u32 sequence, little-endian.
inline constexpr std::size_t kEventBytes = 8;
/// Errors: kTruncated, kMalformed (unknown channel, level neither 0 nor 1).
[[nodiscard]] Result<LineEvent> decode_event(const Packet& packet);
/// Fills `packet.channel` and `packet.bytes`.
void encode_event(const LineEvent& event, Packet& packet);

/// A row of gpio.csv: stamp_ns,line,level.
struct CsvRow {
  std::int64_t stamp_ns = 0;
  std::string_view line;  ///< in the text's memory; 1 … kMaxName of letters, digits, `_`, `-`, `.`
  bool level = false;
};
inline constexpr std::size_t kMaxName = 32, kMaxCsvLine = 128;
inline constexpr std::string_view kCsvHeader = "stamp_ns,line,level\n";
/// Null for the header, an empty line and a comment (#). Errors: kMalformed with the column, kLimit.
[[nodiscard]] Result<std::optional<CsvRow>> parse_csv(std::string_view line);
/// Appends the row with line feed.
void append_csv(std::string& out, std::int64_t stamp_ns, std::string_view line, bool level);

}  // namespace cairn::gpio
