// SPDX-License-Identifier: Apache-2.0
#include "drivers/thermal/thermal.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/thermal/lepton.hpp"

namespace cairn::thermal {
namespace {

using namespace std::chrono_literals;
using camera::FrameFormat;
using camera::test::header_of;
using camera::test::packet_of;
using test::lepton3;
using test::Telemetry;

Thermal thermal(const std::string& model, const std::string& units) {
  Config config;
  config.model = model;
  config.units = units;
  return Thermal::create(config).value();
}

Packet plain(std::uint32_t width, std::uint32_t height, std::uint16_t count) {
  std::vector<std::byte> payload(std::size_t{width} * height * 2);
  for (std::size_t i = 0; i < payload.size(); i += 2) std::memcpy(&payload[i], &count, 2);
  return packet_of(header_of(FrameFormat::kY16, width, height, 2 * width), payload, 1);
}

struct Units {
  const char *model, *units;
  std::uint32_t width, height;
  std::uint16_t count;
  double celsius;
};
class UnitsTest : public testing::TestWithParam<Units> {};

TEST_P(UnitsTest, ConfiguredUnitsBecomeDegrees) {
  const Units& u = GetParam();
  Thermal decoder = thermal(u.model, u.units);
  const auto image = decoder.decode(plain(u.width, u.height, u.count));
  ASSERT_TRUE(image) << to_string(image.error());
  ASSERT_TRUE((*image)->radiometric());
  EXPECT_NEAR((*image)->values.view().at<float>(3, 2), u.celsius, 1e-4);
}
INSTANTIATE_TEST_SUITE_P(All, UnitsTest,
                         testing::Values(Units{"lepton3", "centikelvin", 160, 120, 30'515, 32},
                                         Units{"lepton2", "decikelvin", 80, 60, 3'000, 26.85},
                                         Units{"boson640", "centikelvin", 640, 512, 27'315, 0},
                                         Units{"optris_pi450", "optris", 382, 288, 1'365, 36.5},
                                         Units{"plain", "centikelvin", 6, 4, 0, -273.15}));

TEST(Thermal, WithoutAUnitThereIsNoTemperature) {
  for (const char* units : {"auto", "counts"}) {
    Thermal decoder = thermal("plain", units);
    const auto image = decoder.decode(plain(6, 4, 30'515));
    ASSERT_TRUE(image);
    EXPECT_FALSE((*image)->radiometric());
    EXPECT_EQ((*image)->values.format, PixelFormat::kMono16);
    EXPECT_EQ((*image)->values.view().at<std::uint16_t>(5, 3), 30'515);
  }
}

TEST(Thermal, TheCamerasWordGoesBeforeTheConfiguration) {
  const auto celsius = [](const std::string& units, const Telemetry& telemetry, std::uint16_t count) {
    Thermal decoder = thermal("lepton3", units);
    const auto image = decoder.decode(lepton3(telemetry, count, 1));
    EXPECT_TRUE(image);
    EXPECT_EQ((*image)->values.height, 120);
    EXPECT_EQ((*image)->stretched.height, 120);
    return (*image)->radiometric() ? (*image)->values.view().at<float>(0, 119) : -1000.0F;
  };
  EXPECT_NEAR(celsius("auto", Telemetry{}.tlinear(true, true), 30'000), 26.85, 1e-4);
  EXPECT_NEAR(celsius("auto", Telemetry{}.tlinear(true, false), 3'000), 26.85, 1e-4);
  EXPECT_NEAR(celsius("centikelvin", Telemetry{}.tlinear(true, false), 3'000), 26.85, 1e-4);
  EXPECT_EQ(celsius("centikelvin", Telemetry{}.tlinear(false, true), 30'000), -1000);
  EXPECT_EQ(celsius("auto", Telemetry{}.tlinear(true, true).put32(3, 1U << 12U), 200), -1000) << "automatic gain";
  EXPECT_EQ(celsius("counts", Telemetry{}.tlinear(true, true), 30'000), -1000);
}

TEST(Thermal, FramesDuringAndASecondAfterACorrectionAreMarked) {
  Thermal decoder = thermal("lepton3", "auto");
  std::uint32_t counter = 0;
  const auto marked = [&](Duration at, FlatField state, Duration last) {
    const auto ms = [](Duration d) { return static_cast<std::uint32_t>(d / 1ms); };
    const Telemetry telemetry = Telemetry{}
                                    .counter(++counter)
                                    .put32(1, ms(at))
                                    .put32(3, static_cast<std::uint32_t>(state) << 4U)
                                    .put32(30, ms(last));
    return (*decoder.decode(lepton3(telemetry, 8000, counter, Time{at})))->correcting;
  };
  EXPECT_FALSE(marked(10s, FlatField::kNever, 0s));
  EXPECT_TRUE(marked(10'100ms, FlatField::kImminent, 0s));
  EXPECT_TRUE(marked(10'600ms, FlatField::kRunning, 0s));
  EXPECT_TRUE(marked(10'800ms, FlatField::kComplete, 10'700ms));
  EXPECT_TRUE(marked(11'699ms, FlatField::kComplete, 10'700ms));
  EXPECT_FALSE(marked(11'700ms, FlatField::kComplete, 10'700ms));
  EXPECT_FALSE(marked(60s, FlatField::kComplete, 10'700ms));
  EXPECT_EQ(decoder.counters().correcting, 4U);
}

TEST(Thermal, FramesThatTheCameraRepeatsAreNothingNew) {
  Thermal decoder = thermal("lepton3", "auto");
  int fresh = 0;
  for (std::uint32_t i = 0; i < 9; ++i) {  // 27 Hz on the bus, 9 Hz in the sensor
    const auto image = decoder.decode(lepton3(Telemetry{}.counter(100 + i / 3), 8000, i));
    ASSERT_TRUE(image);
    fresh += *image != nullptr ? 1 : 0;
  }
  EXPECT_EQ(fresh, 3);
  EXPECT_EQ(decoder.counters().repeated, 6U);
}

TEST(Thermal, RefusesOtherSizesAndFormats) {
  Thermal decoder = thermal("lepton3", "auto");
  EXPECT_FALSE(decoder.decode(plain(80, 60, 1)));
  EXPECT_FALSE(decoder.decode(plain(160, 121, 1)));
  EXPECT_FALSE(
      decoder.decode(packet_of(header_of(FrameFormat::kGrey, 160, 120, 160), std::vector<std::byte>(160 * 120))));
  Packet cut = plain(160, 120, 1);
  cut.bytes.pop_back();
  EXPECT_FALSE(decoder.decode(cut));
  EXPECT_EQ(decoder.counters().rejected, 4U);
  EXPECT_TRUE(decoder.decode(plain(160, 120, 1)));
}

TEST(Thermal, RowsOfUnknownContentAreTakenOff) {
  Thermal decoder = thermal("boson320", "centikelvin");
  const auto image = decoder.decode(plain(320, 258, 30'000));
  ASSERT_TRUE(image);
  EXPECT_EQ((*image)->values.height, 256);
  EXPECT_FALSE(decoder.telemetry());
}

TEST(Stretch, KeepsTheOrderAndUsesTheWholeRange) {
  Image counts, out;
  counts.resize(PixelFormat::kMono16, 100, 10);
  for (std::size_t i = 0; i < 1000; ++i) {
    const auto value = static_cast<std::uint16_t>(20'000 + i);
    std::memcpy(&counts.bytes[2 * i], &value, 2);
  }
  Stretch(0.01, 0.99).apply(counts.view(), 100, out);
  EXPECT_EQ(out.bytes.front(), std::byte{0});
  EXPECT_EQ(out.bytes.back(), std::byte{255});
  for (std::size_t i = 1; i < 1000; ++i) EXPECT_GE(out.bytes[i], out.bytes[i - 1]);
}

/// One picture leaves nothing behind for the next.
TEST(Stretch, RemembersNoOtherPicture) {
  const auto picture = [](std::uint16_t first, std::uint16_t step) {
    Image counts;
    counts.resize(PixelFormat::kMono16, 40, 30);
    for (std::size_t i = 0; i < 1200; ++i) {
      const auto value = static_cast<std::uint16_t>(first + i * step);
      std::memcpy(&counts.bytes[2 * i], &value, 2);
    }
    return counts;
  };
  Stretch used(0.005, 0.995);
  for (const Image& counts : {picture(0, 54), picture(30'000, 1), picture(100, 3), picture(64'000, 0)}) {
    Image out, fresh;
    used.apply(counts.view(), 100, out);
    Stretch(0.005, 0.995).apply(counts.view(), 100, fresh);
    EXPECT_EQ(out.bytes, fresh.bytes);
  }
}

TEST(Stretch, NoiseStaysGrey) {
  Image counts, out;
  counts.resize(PixelFormat::kMono16, 2, 1);
  const std::array<std::uint16_t, 2> values{8000, 8002};
  std::memcpy(counts.bytes.data(), values.data(), 4);
  Stretch(0, 1).apply(counts.view(), 100, out);
  EXPECT_NEAR(std::to_integer<int>(out.bytes[0]), 125, 2);
  EXPECT_NEAR(std::to_integer<int>(out.bytes[1]), 130, 2);
}

TEST(ThermalConfig, SaysWhatIsWrong) {
  Config config;
  EXPECT_TRUE(check(config));
  config.capture.format = "YUYV";
  config.stretch_percent = {90, 10};
  const auto faults = check(config);
  ASSERT_FALSE(faults);
  EXPECT_NE(faults.error().detail.find("Y16"), std::string::npos);
  EXPECT_NE(faults.error().detail.find("stretch_percent"), std::string::npos);
}

}  // namespace
}  // namespace cairn::thermal
