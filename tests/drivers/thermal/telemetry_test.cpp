// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/telemetry.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/thermal/lepton.hpp"

namespace cairn::thermal {
namespace {

using namespace std::chrono_literals;

TEST(LeptonTelemetry, ReadsWhatTheDatasheetSays) {
  const auto parsed = parse_lepton_telemetry(test::Telemetry{}
                                                 .put32(1, 123'456)
                                                 .put32(3, 1U << 3U | 2U << 4U | 1U << 12U | 1U << 20U)
                                                 .put32(20, 70'000)
                                                 .put16(24, 30'115)
                                                 .put16(26, 29'815)
                                                 .put32(30, 120'000)
                                                 .tlinear(true, true)
                                                 .bytes());
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->uptime, 123'456ms);
  EXPECT_EQ(parsed->last_correction, 120s);
  EXPECT_EQ(parsed->flat_field, FlatField::kRunning);
  EXPECT_TRUE(parsed->correction_desired);
  EXPECT_TRUE(parsed->agc);
  EXPECT_TRUE(parsed->overheated);
  EXPECT_EQ(parsed->frame_counter, 70'000U);
  EXPECT_NEAR(parsed->sensor_celsius, 28, 1e-9);
  EXPECT_NEAR(parsed->housing_celsius, 25, 1e-9);
  EXPECT_TRUE(parsed->tlinear);
  EXPECT_TRUE(parsed->centikelvin);
}

TEST(LeptonTelemetry, EveryStateOfTheCorrection) {
  for (std::uint32_t state = 0; state < 4; ++state) {
    const auto parsed = parse_lepton_telemetry(test::Telemetry{}.put32(3, state << 4U).bytes());
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->flat_field, static_cast<FlatField>(state));
    EXPECT_FALSE(parsed->correction_desired || parsed->agc || parsed->overheated);
  }
}

TEST(LeptonTelemetry, PixelsAreNoTelemetry) {
  std::vector<std::byte> pixels(kTelemetryBytes, std::byte{0x75});
  EXPECT_EQ(parse_lepton_telemetry(pixels).error().code, Errc::kMalformed);
  EXPECT_EQ(parse_lepton_telemetry(std::span(pixels).first(kTelemetryBytes - 1)).error().code, Errc::kTruncated);
}

}  // namespace
}  // namespace cairn::thermal
