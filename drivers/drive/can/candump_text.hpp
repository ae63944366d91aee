// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/drive/can/candump.hpp"

/// What the readers of both candump forms share.
namespace cairn::drive::candump {

/// Walks over a line; never past its end.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}
  [[nodiscard]] std::size_t column() const { return at_; }
  [[nodiscard]] bool done() const { return at_ == text_.size(); }
  [[nodiscard]] char peek() const { return done() ? '\0' : text_[at_]; }
  [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }
  void skip_space() {
    while (peek() == ' ' || peek() == '\t') ++at_;
  }
  /// Goes past `c` if it comes next; false if it does not.
  bool take(char c) {
    if (done() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  /// Goes past `word` if it comes next; false if it does not.
  bool take(std::string_view word) {
    if (!rest().starts_with(word)) return false;
    at_ += word.size();
    return true;
  }
  /// Up to the next space or tab.
  std::string_view word() { return advance(std::min(rest().find_first_of(" \t"), rest().size())); }
  /// The next `n` characters, or fewer at the end of the line.
  std::string_view advance(std::size_t n) {
    const std::string_view part = text_.substr(at_, n);
    at_ += part.size();
    return part;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// An Error kMalformed at the cursor's column.
[[nodiscard]] inline Error fault(const Cursor& at, std::string_view cause) {
  return {Errc::kMalformed, cause, {}, at.column(), {}};
}

/// 0 … 15, or −1.
[[nodiscard]] constexpr int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}
/// All of `digits` (1 … 8 of them).
[[nodiscard]] std::optional<std::uint32_t> parse_hex(std::string_view digits);
/// What stands between ( and ), as far as it is a stamp of candump.
[[nodiscard]] std::optional<Time> parse_stamp(std::string_view text);
/// Takes an identifier of 3 or 8 digits.
[[nodiscard]] Result<std::uint32_t> parse_id(std::string_view digits, const Cursor& at);

/// Reads a frame in the form of a log file, after the interface.
[[nodiscard]] Result<void> parse_log_frame(Cursor& line, CandumpLine& out);
/// Reads a frame in the form of the console, after the interface.
[[nodiscard]] Result<void> parse_console_frame(Cursor& line, CandumpLine& out);

}  // namespace cairn::drive::candump
