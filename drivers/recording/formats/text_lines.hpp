// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace cairn::recording {

/// Walks over the lines of a text, without the line ends (LF or CRLF); a last line needs none.
class LineReader {
 public:
  LineReader(std::string_view text, std::string_view name) : text_(text), name_(name) {}

  /// The next line, or null at the end.
  std::optional<std::string_view> next();
  [[nodiscard]] std::uint64_t line() const { return line_; }         ///< of the last line returned, counted from 1
  [[nodiscard]] std::uint64_t offset() const { return offset_; }     ///< where that line starts
  [[nodiscard]] std::uint64_t next_offset() const { return next_; }  ///< where the following line starts
  /// An Error at the last line returned.
  [[nodiscard]] Error fault(Errc code, std::string_view cause, const std::string& detail = {}) const;

 private:
  std::string_view text_, name_;
  std::uint64_t line_ = 0, offset_ = 0;
  std::size_t next_ = 0;
};

/// Splits at single `separator`s, which may be ' ' for any run of spaces and tabs. Returns how many parts there are;
/// parts beyond `out` are counted, not stored.
template <std::size_t N>
std::size_t split(std::string_view line, char separator, std::string_view (&out)[N]);

[[nodiscard]] std::string_view trimmed(std::string_view text);
/// A finite number that fills all of `text`.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);
/// Decimal seconds as nanoseconds: exact for plain decimals up to nanoseconds, |seconds| < 9.2e9.
[[nodiscard]] std::optional<std::int64_t> parse_seconds(std::string_view text);

template <std::size_t N>
std::size_t split(std::string_view line, char separator, std::string_view (&out)[N]) {
  std::size_t parts = 0;
  const auto keep = [&](std::string_view part) {
    if (parts < N) out[parts] = part;
    ++parts;
  };
  if (separator != ' ') {
    for (;;) {
      const std::size_t end = line.find(separator);
      keep(trimmed(line.substr(0, end)));
      if (end == std::string_view::npos) return parts;
      line.remove_prefix(end + 1);
    }
  }
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const std::size_t end = line.find_first_of(" \t");
    keep(line.substr(0, end));
    line.remove_prefix(end == std::string_view::npos ? line.size() : end);
  }
  return parts;
}

}  // namespace cairn::recording
