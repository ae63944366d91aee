// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/telemetry.hpp"

#include "hal/bytes.hpp"

namespace cairn::thermal {
namespace {

// Word numbers: row A starts at 0, row C at 160.
constexpr std::size_t kUptime = 1, kStatus = 3, kFrameCounter = 20, kSensorTemperature = 24, kHousingTemperature = 26,
                      kLastCorrection = 30, kTlinear = 160 + 48, kTlinearResolution = 160 + 49;
// Status bits.
constexpr std::uint32_t kDesired = 1U << 3U, kAgc = 1U << 12U, kOverheated = 1U << 20U;
constexpr std::uint32_t kFlatFieldShift = 4, kFlatFieldMask = 3;

}  // namespace

Result<LeptonTelemetry> parse_lepton_telemetry(std::span<const std::byte> rows) {
  if (rows.size() < kTelemetryBytes) return Error{Errc::kTruncated, "telemetry rows are too short"};
  const auto word = [&](std::size_t i) { return load_le<std::uint16_t>(rows, 2 * i); };
  const auto two_words = [&](std::size_t i) { return load_le<std::uint32_t>(rows, 2 * i); };
  const auto milliseconds = [&](std::size_t i) { return std::chrono::milliseconds(two_words(i)); };
  if (word(kTlinear) > 1 || word(kTlinearResolution) > 1)
    return Error{Errc::kMalformed, "the rows behind the picture are no Lepton telemetry", {}, 2 * kTlinear, {}};
  const std::uint32_t status = two_words(kStatus);
  LeptonTelemetry t;
  t.uptime = milliseconds(kUptime);
  t.last_correction = milliseconds(kLastCorrection);
  t.flat_field = static_cast<FlatField>(status >> kFlatFieldShift & kFlatFieldMask);
  t.correction_desired = (status & kDesired) != 0;
  t.agc = (status & kAgc) != 0;
  t.overheated = (status & kOverheated) != 0;
  t.frame_counter = two_words(kFrameCounter);
  t.sensor_celsius = 0.01 * word(kSensorTemperature) - 273.15;
  t.housing_celsius = 0.01 * word(kHousingTemperature) - 273.15;
  t.tlinear = word(kTlinear) == 1;
  t.centikelvin = word(kTlinearResolution) == 1;
  return t;
}

}  // namespace cairn::thermal
