// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/line_event.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "hal/bytes.hpp"

namespace cairn::gpio {
namespace {

constexpr std::array<std::string_view, kLines> kNames{"estop", "trigger", "pps"};

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxName && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  });
}

}  // namespace

std::string_view name_of(Line line) {
  const auto i = static_cast<std::size_t>(line);
  return i < kLines ? kNames[i] : "unknown";
}

std::optional<Line> line_named(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Line>(found - kNames.begin());
}

Result<LineEvent> decode_event(const Packet& packet) {
  const auto bytes = packet.payload();
  if (bytes.size() != kEventBytes) return Error{Errc::kTruncated, "a line event has 8 bytes", {}, bytes.size(), {}};
  if (packet.channel >= kLines) return Error{Errc::kMalformed, "no such line", {}, 0, {}};
  if (bytes[0] > std::byte{1} || bytes[1] > std::byte{1})
    return Error{Errc::kMalformed, "a level is 0 or 1", {}, 0, {}};
  return LineEvent{static_cast<Line>(packet.channel), bytes[0] == std::byte{1}, bytes[1] == std::byte{1},
                   load_le<std::uint32_t>(bytes, 4)};
}

void encode_event(const LineEvent& event, Packet& packet) {
  packet.channel = static_cast<std::uint16_t>(event.line);
  packet.bytes.assign(4, std::byte{0});
  packet.bytes[0] = std::byte{event.level};
  packet.bytes[1] = std::byte{event.sampled};
  append_le(packet.bytes, event.sequence);
}

Result<std::optional<CsvRow>> parse_csv(std::string_view line) {
  const auto fault = [](std::string_view cause, std::size_t column) {
    return Error{Errc::kMalformed, cause, {}, column, {}};
  };
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.size() > kMaxCsvLine) return Error{Errc::kLimit, "the line is too long", {}, kMaxCsvLine, {}};
  if (line.empty() || line.front() == '#' || line == kCsvHeader.substr(0, kCsvHeader.size() - 1))
    return std::optional<CsvRow>();
  CsvRow row;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), row.stamp_ns);
  const auto first = static_cast<std::size_t>(end - line.data());
  constexpr std::int64_t kLimit = std::int64_t{1} << 61;
  if (error != std::errc{} || row.stamp_ns < -kLimit || row.stamp_ns > kLimit)
    return fault("stamp in nanoseconds expected", 0);
  if (first == line.size() || line[first] != ',') return fault("a comma must follow the stamp", first);
  const std::size_t second = line.find(',', first + 1);
  if (second == std::string_view::npos) return fault("three columns expected: stamp_ns,line,level", first);
  row.line = line.substr(first + 1, second - first - 1);
  if (!is_name(row.line)) return fault("no name of a line", first + 1);
  const std::string_view level = line.substr(second + 1);
  if (level != "0" && level != "1") return fault("a level is 0 or 1", second + 1);
  row.level = level == "1";
  return std::optional(row);
}

void append_csv(std::string& out, std::int64_t stamp_ns, std::string_view line, bool level) {
  out.append(std::to_string(stamp_ns)).append(",").append(line).append(level ? ",1\n" : ",0\n");
}

}  // namespace cairn::gpio
