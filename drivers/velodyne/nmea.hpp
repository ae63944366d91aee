// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/result.hpp"

namespace cairn::velodyne {

/// A place by WGS 84.
struct GeoPlace {
  double latitude_deg = 0, longitude_deg = 0;  ///< north and east are positive
};

/// The time and place in a $..RMC or $..GGA sentence.
struct NmeaFix {
  bool valid = false;                  ///< RMC status A, or a GGA fix quality above 0
  std::int64_t time_of_day_us = 0;     ///< UTC
  std::optional<std::int64_t> utc_us;  ///< since 1970; RMC only, GGA has no date
  std::optional<GeoPlace> place;       ///< none: the sentence has no place, or a bad one
};

/// Reads one sentence, from '$' to the checksum. Further text is ignored. Two-digit years mean 1980 … 2079. Errors:
/// kMalformed (no sentence, wrong checksum, a bad field), kTruncated (no checksum, as old firmware leaves it),
/// kUnsupported (another sentence).
[[nodiscard]] Result<NmeaFix> parse_nmea(std::string_view text);

}  // namespace cairn::velodyne
