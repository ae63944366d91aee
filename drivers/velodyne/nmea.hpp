// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/result.hpp"

namespace cairn::velodyne {

/// The time in a $..RMC or $..GGA sentence.
struct NmeaTime {
  bool valid = false;                  ///< RMC status A, or a GGA fix quality above 0
  std::int64_t time_of_day_us = 0;     ///< UTC
  std::optional<std::int64_t> utc_us;  ///< since 1970; RMC only, GGA has no date
};

/// Reads one sentence, from '$' to the checksum. Further text is ignored. Two-digit years mean 1980 … 2079. Errors:
/// kMalformed (no sentence, wrong checksum, a bad field), kTruncated (no checksum, as old firmware leaves it),
/// kUnsupported (another sentence).
[[nodiscard]] Result<NmeaTime> parse_nmea(std::string_view text);

}  // namespace cairn::velodyne
