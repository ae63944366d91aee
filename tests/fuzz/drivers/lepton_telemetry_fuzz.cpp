// SPDX-License-Identifier: Apache-2.0
// Any bytes as telemetry rows: refused, or times and temperatures within their words' ranges.
#include <cstdlib>

#include "drivers/thermal/telemetry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn::thermal;
  const auto parsed = parse_lepton_telemetry({reinterpret_cast<const std::byte*>(data), size});
  if (parsed.has_value() && size < kTelemetryBytes) std::abort();
  if (!parsed) return 0;
  constexpr cairn::Duration kLongest = std::chrono::milliseconds(0xFFFFFFFF);
  const bool sound = parsed->uptime >= cairn::Duration{} && parsed->uptime <= kLongest &&
                     parsed->last_correction >= cairn::Duration{} && parsed->last_correction <= kLongest &&
                     parsed->flat_field <= FlatField::kComplete && parsed->sensor_celsius > -273.2 &&
                     parsed->sensor_celsius < 383 && parsed->housing_celsius > -273.2 && parsed->housing_celsius < 383;
  if (!sound) std::abort();
  return 0;
}
