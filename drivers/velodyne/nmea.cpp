// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/nmea.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <numeric>
#include <span>

namespace cairn::velodyne {
namespace {

constexpr std::size_t kMaxSentence = 128;
constexpr std::size_t kMaxFields = 10;  // nothing that is needed stands later
using Fields = std::array<std::string_view, kMaxFields>;

/// Exactly these decimal or hexadecimal digits, or nothing.
std::optional<int> number(std::string_view digits, int base = 10) {
  int value = 0;
  if (digits.empty() || digits.front() == '-') return std::nullopt;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

Fields split(std::string_view body) {
  Fields fields;
  for (std::string_view& field : fields) {
    const std::size_t comma = body.find(',');
    field = body.substr(0, comma);
    body = comma == std::string_view::npos ? std::string_view{} : body.substr(comma + 1);
  }
  return fields;
}

/// hhmmss or hhmmss.fraction; a leap second (60) counts as the next minute's first.
std::optional<std::int64_t> time_of_day_us(std::string_view field) {
  if (field.size() < 6) return std::nullopt;
  const auto h = number(field.substr(0, 2)), m = number(field.substr(2, 2)), s = number(field.substr(4, 2));
  if (!h || !m || !s || *h > 23 || *m > 59 || *s > 60) return std::nullopt;
  std::int64_t micros = 0;
  if (field.size() > 6) {
    if (field[6] != '.') return std::nullopt;
    std::int64_t weight = 100'000;
    for (const char digit : field.substr(7)) {
      if (digit < '0' || digit > '9') return std::nullopt;
      micros += weight * (digit - '0');
      weight /= 10;
    }
  }
  return ((*h * 60LL + *m) * 60 + *s) * 1'000'000 + micros;
}

/// ddmmyy → µs from 1970 to the day's start.
std::optional<std::int64_t> date_us(std::string_view field) {
  if (field.size() != 6) return std::nullopt;
  const auto d = number(field.substr(0, 2)), m = number(field.substr(2, 2)), y = number(field.substr(4, 2));
  if (!d || !m || !y) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*y < 80 ? 2000 + *y : 1900 + *y},
                                         std::chrono::month{static_cast<unsigned>(*m)},
                                         std::chrono::day{static_cast<unsigned>(*d)}};
  if (!date.ok()) return std::nullopt;
  return std::chrono::microseconds(std::chrono::sys_days{date}.time_since_epoch()).count();
}

/// The text between '$' and '*' when its checksum is right.
Result<std::string_view> checked_body(std::string_view text) {
  text = text.substr(0, kMaxSentence);
  if (text.empty() || text.front() != '$') return Error{Errc::kMalformed, "NMEA sentence does not begin with $"};
  const std::size_t star = text.find('*');
  if (star == std::string_view::npos || star + 3 > text.size())
    return Error{Errc::kTruncated, "NMEA sentence has no checksum"};
  const std::string_view body = text.substr(1, star - 1);
  const auto sum = std::accumulate(body.begin(), body.end(), 0, [](int x, char c) { return x ^ static_cast<int>(c); });
  const auto written = number(text.substr(star + 1, 2), 16);
  if (!written || *written != (sum & 0xFF)) return Error{Errc::kMalformed, "NMEA checksum is wrong"};
  return body;
}

Result<NmeaTime> from_rmc(const Fields& f) {
  const auto time = time_of_day_us(f[1]);
  const auto date = date_us(f[9]);
  if (!time || !date || (f[2] != "A" && f[2] != "V")) return Error{Errc::kMalformed, "RMC sentence has a bad field"};
  return NmeaTime{f[2] == "A", *time, *date + *time};
}

Result<NmeaTime> from_gga(const Fields& f) {
  const auto time = time_of_day_us(f[1]);
  const auto quality = number(f[6]);
  if (!time || !quality) return Error{Errc::kMalformed, "GGA sentence has a bad field"};
  return NmeaTime{*quality > 0, *time, std::nullopt};
}

}  // namespace

Result<NmeaTime> parse_nmea(std::string_view text) {
  const auto body = checked_body(text);
  if (!body) return body.error();
  const Fields fields = split(*body);
  const std::string_view kind = fields[0].size() == 5 ? fields[0].substr(2) : std::string_view{};
  if (kind == "RMC") return from_rmc(fields);
  if (kind == "GGA") return from_gga(fields);
  return Error{Errc::kUnsupported, "NMEA sentence is neither RMC nor GGA"};
}

}  // namespace cairn::velodyne
