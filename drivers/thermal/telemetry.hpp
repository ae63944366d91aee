// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::thermal {

/// Flat-field correction: the shutter closes and the offset of every pixel is measured again. The picture freezes
/// meanwhile.
enum class FlatField : std::uint8_t { kNever = 0, kImminent = 1, kRunning = 2, kComplete = 3 };

/// The telemetry behind the picture of a Lepton, if it is switched on (FLIR Lepton Engineering Datasheet, "Telemetry
/// Modes"): rows A, B and C of 80 words each. A Lepton 2 has three lines of 80 words, a Lepton 3 two of 160.
struct LeptonTelemetry {
  Duration uptime{};
  Duration last_correction{};  ///< uptime when the last flat-field correction ended
  FlatField flat_field = FlatField::kNever;
  bool correction_desired = false;
  bool agc = false;  ///< automatic gain: counts are not temperatures
  bool overheated = false;
  std::uint32_t frame_counter = 0;
  double sensor_celsius = 0;  ///< of the focal plane array
  double housing_celsius = 0;
  bool tlinear = false;      ///< counts are kelvins
  bool centikelvin = false;  ///< counts are 0.01 K, otherwise 0.1 K; means nothing without tlinear
};

inline constexpr std::size_t kTelemetryWords = 240;
inline constexpr std::size_t kTelemetryBytes = 2 * kTelemetryWords;

/// `rows`: words A 0 to C 79, little-endian as PureThermal sends them, without the padding between lines. Errors:
/// kTruncated; kMalformed if a switch is neither on nor off, because the rows are then not telemetry.
[[nodiscard]] Result<LeptonTelemetry> parse_lepton_telemetry(std::span<const std::byte> rows);

}  // namespace cairn::thermal
