// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/time.hpp"

namespace cairn::peer_link {

/// Bounds a log whose lines an attacker can cause: at most kLinesOfAKind of a kind are written in kPeriod. The others
/// are counted, and summed up in one line at the end of the period. Lines are of one kind when they differ only in
/// numbers and bytes. Not for several threads at once.
class LogLimiter {
 public:
  static constexpr Duration kPeriod = std::chrono::minutes(1);
  static constexpr std::size_t kKinds = 8;  ///< that are told apart; all others together are one more
  static constexpr std::uint64_t kLinesOfAKind = 2;
  static constexpr std::size_t kLongest = 200;  ///< bytes of a line; the rest is cut off

  /// Appends to `out` what is to be written now: the summary of a period that is over, and the line unless its kind
  /// has had its share.
  void add(Time now, std::string_view line, std::vector<std::string>& out);
  /// Appends the summary if the period is over at `now`.
  void settle(Time now, std::vector<std::string>& out);
  /// Appends the summary of the running period, at the end of the program.
  void finish(std::vector<std::string>& out);

  /// The line with every number and every run of hexadecimal bytes replaced by '#', cut to its beginning.
  [[nodiscard]] static std::string kind_of(std::string_view line);

 private:
  struct Kind {
    std::string name, example;
    std::uint64_t lines = 0;
  };
  Kind& kind(std::string_view line);

  std::vector<Kind> kinds_;  // of the running period; the last may stand for all others
  Time begun_{};
  bool running_ = false;
};

}  // namespace cairn::peer_link
