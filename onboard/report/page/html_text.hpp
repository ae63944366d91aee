// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cairn::report::html {

/// Text that cannot leave its place in HTML, be it content or a quoted attribute. Control characters other than tab and
/// newline become U+FFFD.
[[nodiscard]] std::string escape(std::string_view text);

/// RFC 4648, for data: addresses.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// About three digits, without an exponent between 0.001 and a million; "–" for what is not finite.
[[nodiscard]] std::string number(double value);
/// 3.20 mm, 12.3 cm, 4.56 m.
[[nodiscard]] std::string length(double metres);
/// 1 234 567, with narrow spaces.
[[nodiscard]] std::string count(std::uint64_t value);
/// 512 B, 1.50 KiB, 12.3 MiB …
[[nodiscard]] std::string bytes(double value);
/// What stands in the place of a figure that the run did not measure.
inline constexpr const char* kNotMeasured = "not measured";
/// The figure as `text` writes it, or kNotMeasured.
template <class T, class Text>
[[nodiscard]] std::string measured(const std::optional<T>& figure, Text&& text) {
  return figure ? text(*figure) : std::string(kNotMeasured);
}
/// 35 s, 2:05 min, 1:02:03 h.
[[nodiscard]] std::string duration(double seconds);

}  // namespace cairn::report::html
