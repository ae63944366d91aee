// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/text_lines.hpp"

#include <charconv>
#include <cmath>

#include "hal/time.hpp"

namespace cairn::recording {

std::optional<std::string_view> LineReader::next() {
  if (next_ >= text_.size()) return std::nullopt;
  offset_ = next_;
  ++line_;
  const std::size_t end = std::min(text_.find('\n', next_), text_.size());
  std::string_view line = text_.substr(next_, end - next_);
  next_ = end + 1;
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

Error LineReader::fault(Errc code, std::string_view cause, const std::string& detail) const {
  std::string where = "line " + std::to_string(line_);
  if (!detail.empty()) where += ": " + detail;
  return {code, cause, std::string(name_), offset_, std::move(where)};
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_seconds(std::string_view text) {
  constexpr double kLimit = 9.2e9;
  const bool negative = text.starts_with('-');
  const std::string_view plain = text.substr(negative ? 1 : 0);
  const std::size_t point = std::min(plain.find('.'), plain.size());
  const std::string_view whole = plain.substr(0, point);
  const std::string_view fraction = plain.substr(std::min(point + 1, plain.size()));
  const bool exact = plain.find_first_not_of("0123456789.") == std::string_view::npos && !whole.empty() &&
                     whole.size() <= 10 && fraction.size() <= 9 && fraction.find('.') == std::string_view::npos;
  if (exact) {
    std::int64_t ns = 0;
    for (const char c : whole) ns = ns * 10 + (c - '0');
    if (static_cast<double>(ns) >= kLimit) return std::nullopt;
    for (std::size_t i = 0; i < 9; ++i) ns = ns * 10 + (i < fraction.size() ? fraction[i] - '0' : 0);
    return negative ? -ns : ns;
  }
  const auto seconds = parse_number(text);
  if (!seconds || std::abs(*seconds) >= kLimit) return std::nullopt;
  return from_seconds(*seconds).count();
}

}  // namespace cairn::recording
