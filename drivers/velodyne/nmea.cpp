// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/nmea.hpp"

#include <algorithm>
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

/// So many digits of degrees, then minutes with a fraction → degrees. `most`: degrees.
std::optional<double> angle_deg(std::string_view field, std::size_t digits, int most) {
  if (field.size() < digits + 2) return std::nullopt;
  const auto degrees = number(field.substr(0, digits)), whole = number(field.substr(digits, 2));
  if (!degrees || !whole || *whole >= 60) return std::nullopt;
  double minutes = *whole, weight = 0.1;
  if (field.size() > digits + 2 && field[digits + 2] != '.') return std::nullopt;
  for (const char digit : field.substr(std::min(field.size(), digits + 3))) {
    if (digit < '0' || digit > '9') return std::nullopt;
    minutes += weight * (digit - '0');
    weight /= 10;
  }
  const double angle = *degrees + minutes / 60;
  return angle <= most ? std::optional(angle) : std::nullopt;
}

/// latitude, N or S, longitude, E or W
std::optional<GeoPlace> place_from(std::span<const std::string_view, 4> f) {
  const auto latitude = angle_deg(f[0], 2, 90), longitude = angle_deg(f[2], 3, 180);
  const bool north = f[1] == "N", east = f[3] == "E";
  if (!latitude || !longitude || (!north && f[1] != "S") || (!east && f[3] != "W")) return std::nullopt;
  return GeoPlace{north ? *latitude : -*latitude, east ? *longitude : -*longitude};
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

Result<NmeaFix> from_rmc(const Fields& f) {
  const auto time = time_of_day_us(f[1]);
  const auto date = date_us(f[9]);
  if (!time || !date || (f[2] != "A" && f[2] != "V")) return Error{Errc::kMalformed, "RMC sentence has a bad field"};
  return NmeaFix{f[2] == "A", *time, *date + *time, place_from(std::span(f).subspan<3, 4>())};
}

Result<NmeaFix> from_gga(const Fields& f) {
  const auto time = time_of_day_us(f[1]);
  const auto quality = number(f[6]);
  if (!time || !quality) return Error{Errc::kMalformed, "GGA sentence has a bad field"};
  return NmeaFix{*quality > 0, *time, std::nullopt, place_from(std::span(f).subspan<2, 4>())};
}

}  // namespace

Result<NmeaFix> parse_nmea(std::string_view text) {
  const auto body = checked_body(text);
  if (!body) return body.error();
  const Fields fields = split(*body);
  const std::string_view kind = fields[0].size() == 5 ? fields[0].substr(2) : std::string_view{};
  if (kind == "RMC") return from_rmc(fields);
  if (kind == "GGA") return from_gga(fields);
  return Error{Errc::kUnsupported, "NMEA sentence is neither RMC nor GGA"};
}

}  // namespace cairn::velodyne
