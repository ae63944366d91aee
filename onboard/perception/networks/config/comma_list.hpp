// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

namespace cairn::networks {

/// The parts between commas, without the blanks around them. A text of blanks has none.
[[nodiscard]] inline std::vector<std::string_view> comma_list(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const auto trimmed = [&](std::string_view part) {
    const std::size_t first = part.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return std::string_view();
    return part.substr(first, part.find_last_not_of(kBlanks) - first + 1);
  };
  std::vector<std::string_view> parts;
  if (trimmed(text).empty()) return parts;
  for (;;) {
    const std::size_t end = text.find(',');
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// A whole number that fills all of `text`.
[[nodiscard]] inline std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace cairn::networks
