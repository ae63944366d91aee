// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace cairn::recording {

/// "2026-11-21T19:31:29.000000000Z" for nanoseconds since 1970 (not negative).
[[nodiscard]] std::string to_iso_utc(std::int64_t utc_ns);

/// Reads `YYYY-MM-DD[T ]hh:mm:ss[.fraction][Z]` (ISO 8601, KITTI's timestamps.txt) as nanoseconds since 1970; fractions
/// below a nanosecond are cut off. Years 1970…2105; null when the text is anything else.
[[nodiscard]] std::optional<std::int64_t> parse_iso_utc(std::string_view text);

}  // namespace cairn::recording
