// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/candump.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "drivers/drive/can/candump_text.hpp"

namespace cairn::drive {
namespace candump {
namespace {

constexpr std::int64_t kMaxSeconds = (std::int64_t{1} << 61) / 1'000'000'000 - 1;

/// All of `digits`, at most 10 of them.
std::optional<std::int64_t> parse_decimal(std::string_view digits) {
  if (digits.empty() || digits.size() > 10) return std::nullopt;
  std::int64_t value = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return value;
}

/// "2024-01-02 03:04:05" as seconds since 1970.
std::optional<std::int64_t> parse_date(std::string_view text) {
  if (text.size() != 19 || text[4] != '-' || text[7] != '-' || text[10] != ' ' || text[13] != ':' || text[16] != ':')
    return std::nullopt;
  const auto part = [&](std::size_t at, std::size_t n) { return parse_decimal(text.substr(at, n)).value_or(-1); };
  const std::array values{part(0, 4), part(5, 2), part(8, 2), part(11, 2), part(14, 2), part(17, 2)};
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(values[0])),
                                         std::chrono::month(static_cast<unsigned>(values[1])),
                                         std::chrono::day(static_cast<unsigned>(values[2]))};
  const bool time =
      values[3] >= 0 && values[3] < 24 && values[4] >= 0 && values[4] < 60 && values[5] >= 0 && values[5] <= 60;
  if (values[0] < 1970 || values[1] < 0 || values[2] < 0 || !date.ok() || !time) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * std::int64_t{24} + values[3]) * 60 + values[4]) * 60 + values[5];
}

bool is_interface(std::string_view name) {
  return !name.empty() && name.size() <= kMaxInterface &&
         std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~' && c != '#' && c != '/'; });
}

/// The line without what -c colours it with (ESC [ … m); at most kMaxCandumpLine characters.
std::string_view without_colours(std::string_view line, std::array<char, kMaxCandumpLine>& memory) {
  if (line.find('\x1b') == std::string_view::npos) return line;
  std::size_t size = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\x1b') {
      while (i < line.size() && line[i] != 'm') ++i;
    } else {
      memory[size++] = line[i];
    }
  }
  return {memory.data(), size};
}

Result<void> parse(Cursor& line, CandumpLine& out) {
  line.skip_space();
  if (line.take('(')) {
    const std::string_view stamp = line.advance(std::min(line.rest().find(')'), line.rest().size()));
    out.stamp = parse_stamp(stamp);
    if (!out.stamp || !line.take(')')) return fault(line, "no stamp of candump");
    line.skip_space();
  }
  out.interface = line.word();
  if (!is_interface(out.interface)) return fault(line, "no name of an interface");
  line.skip_space();
  const std::string_view frame = line.rest().substr(0, line.rest().find_first_of(" \t"));
  return frame.find('#') != std::string_view::npos ? parse_log_frame(line, out) : parse_console_frame(line, out);
}

}  // namespace

std::optional<std::uint32_t> parse_hex(std::string_view digits) {
  if (digits.empty() || digits.size() > 8) return std::nullopt;
  std::uint32_t value = 0;
  for (const char c : digits) {
    if (hex_digit(c) < 0) return std::nullopt;
    value = value << 4 | static_cast<std::uint32_t>(hex_digit(c));
  }
  return value;
}

std::optional<Time> parse_stamp(std::string_view text) {
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::string_view whole = text.substr(0, point), fraction = text.substr(std::min(point + 1, text.size()));
  const auto seconds = whole.find('-') == std::string_view::npos ? parse_decimal(whole) : parse_date(whole);
  if (!seconds || *seconds > kMaxSeconds || fraction.size() > 9) return std::nullopt;
  std::int64_t ns = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const char c = i < fraction.size() ? fraction[i] : '0';
    if (c < '0' || c > '9') return std::nullopt;
    ns = ns * 10 + (c - '0');
  }
  return Time{std::chrono::seconds(*seconds) + std::chrono::nanoseconds(ns)};
}

Result<std::uint32_t> parse_id(std::string_view digits, const Cursor& at) {
  const auto id = parse_hex(digits);
  if (!id || (digits.size() != 3 && digits.size() != 8)) return fault(at, "an identifier has 3 or 8 hex digits");
  if (digits.size() == 3) {
    if (*id > kStandardMask) return fault(at, "identifier above 7FF");
    return *id;
  }
  // canutils' own rule: a set error bit makes an error frame, everything else with 8 digits is extended.
  if ((*id & kErrorFrame) != 0) return *id & (kErrorFrame | kExtendedMask);
  return (*id & kExtendedMask) | kExtended;
}

}  // namespace candump

Result<std::optional<CandumpLine>> parse_candump(std::string_view line) {
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.size() > kMaxCandumpLine) return Error{Errc::kLimit, "the line is too long", {}, kMaxCandumpLine, {}};
  const bool explains_error = line.starts_with('\t');
  const std::size_t first = line.find_first_not_of(" \t");
  if (explains_error || first == std::string_view::npos || line[first] == '#' ||
      line.substr(first).starts_with("DROPCOUNT"))
    return std::optional<CandumpLine>();
  std::array<char, kMaxCandumpLine> memory;
  candump::Cursor cursor(candump::without_colours(line, memory));
  CandumpLine out;
  if (auto parsed = candump::parse(cursor, out); !parsed) return parsed.error();
  // A coloured line was read from a copy: find the name in the line itself.
  const std::size_t name = line.find(out.interface);
  if (name == std::string_view::npos) return candump::fault(cursor, "no name of an interface");
  out.interface = line.substr(name, out.interface.size());
  return std::optional(out);
}

}  // namespace cairn::drive
