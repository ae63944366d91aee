// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/utc.hpp"

#include <charconv>
#include <chrono>
#include <cstdio>

namespace cairn::recording {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

/// The decimal number that fills all of `text`.
std::optional<int> digits(std::string_view text) {
  int value = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return value;
}

/// ".25" → 250000000; empty → 0.
std::optional<std::int64_t> fraction_ns(std::string_view text) {
  if (text.empty()) return 0;
  if (text.front() != '.' || text.size() < 2) return std::nullopt;
  std::int64_t ns = 0;
  for (std::size_t i = 1; i < 10; ++i) ns = ns * 10 + (i < text.size() ? text[i] - '0' : 0);
  for (const char c : text.substr(1))
    if (c < '0' || c > '9') return std::nullopt;
  return ns;
}

}  // namespace

std::string to_iso_utc(std::int64_t utc_ns) {
  const std::int64_t seconds = utc_ns / kNsPerSecond;
  const std::chrono::sys_days day{std::chrono::days(seconds / 86'400)};
  const std::chrono::year_month_day date{day};
  const auto in_day = static_cast<int>(seconds % 86'400);
  char text[64];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d.%09dZ", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), in_day / 3600, in_day / 60 % 60,
                in_day % 60, static_cast<int>(utc_ns % kNsPerSecond));
  return text;
}

std::optional<std::int64_t> parse_iso_utc(std::string_view text) {
  constexpr std::size_t kPlain = 19;  // YYYY-MM-DDThh:mm:ss
  if (text.size() < kPlain || text.size() > 40) return std::nullopt;
  if (text[4] != '-' || text[7] != '-' || (text[10] != 'T' && text[10] != ' ') || text[13] != ':' || text[16] != ':')
    return std::nullopt;
  if (text.ends_with('Z')) text.remove_suffix(1);
  if (text.size() < kPlain) return std::nullopt;
  const auto year = digits(text.substr(0, 4)), month = digits(text.substr(5, 2)), day = digits(text.substr(8, 2));
  const auto hour = digits(text.substr(11, 2)), minute = digits(text.substr(14, 2)),
             second = digits(text.substr(17, 2));
  const auto fraction = fraction_ns(text.substr(kPlain));
  if (!year || !month || !day || !hour || !minute || !second || !fraction) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok() || *year < 1970 || *year > 2105 || *hour > 23 || *minute > 59 || *second > 59) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return (days * 86'400 + *hour * 3600 + *minute * 60 + *second) * kNsPerSecond + *fraction;
}

}  // namespace cairn::recording
