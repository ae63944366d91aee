// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/models.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "drivers/velodyne/device_time.hpp"

namespace cairn::velodyne {
namespace {

std::vector<int> rings(const Model& m) {
  std::vector<int> out;
  for (int c = 0; c < m.channel_count; ++c) out.push_back(m.channels[static_cast<std::size_t>(c)].ring);
  return out;
}

TEST(Models, AreFoundByNameAliasAndProductByte) {
  ASSERT_EQ(models().size(), 4U);
  for (const Model& m : models()) {
    EXPECT_EQ(find_model(m.name), &m);
    EXPECT_EQ(find_model(m.product), &m);
    if (m.alias.empty()) continue;
    EXPECT_EQ(find_model(m.alias), &m);
  }
  EXPECT_EQ(find_model("Puck Hi-Res"), find_model("VLP-16-HiRes"));
  EXPECT_EQ(find_model("vlp16"), nullptr);
  EXPECT_EQ(find_model(""), nullptr);
  EXPECT_EQ(find_model(std::uint8_t{0xA1}), nullptr);
}

// The rings that the manuals print; ours are computed from the elevations.
TEST(Models, RingsAreThoseOfTheManuals) {
  const std::vector<int> of16{0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15};
  EXPECT_EQ(rings(*find_model("VLP-16")), of16);
  EXPECT_EQ(rings(*find_model("VLP-16-HiRes")), of16);
  EXPECT_THAT(rings(*find_model("HDL-32E")),
              testing::ElementsAre(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23, 8, 24, 9, 25, 10, 26, 11, 27,
                                   12, 28, 13, 29, 14, 30, 15, 31));
  EXPECT_THAT(rings(*find_model("VLP-32C")),
              testing::ElementsAre(0, 17, 15, 1, 2, 20, 18, 3, 4, 21, 19, 5, 6, 24, 22, 8, 7, 25, 23, 9, 10, 27, 26, 12,
                                   11, 29, 28, 13, 14, 31, 30, 16));
}

// All beams leave through one point: offset = f·tan(−elevation), with f as the manuals draw it. The Hi-Res manual's
// table was evidently made by halving steps and is up to 0.42 mm off that.
TEST(Models, VerticalOffsetsFollowTheFocalDistance) {
  const std::tuple<const char*, double, double> focal_mm[] = {
      {"VLP-16", 41.91, 0.06}, {"VLP-16-HiRes", 41.91, 0.42}, {"HDL-32E", 28.83, 0.09}, {"VLP-32C", 42.4, 1e-6}};
  for (const auto& [name, f, tolerance] : focal_mm) {
    const Model& m = *find_model(name);
    for (int c = 0; c < m.channel_count; ++c) {
      const Channel& channel = m.channels[static_cast<std::size_t>(c)];
      const double expected_mm = f * std::tan(-channel.elevation_deg * std::numbers::pi / 180.0);
      EXPECT_NEAR(1e3 * channel.vertical_offset_m, expected_mm, tolerance) << name << " channel " << c;
    }
  }
}

TEST(Models, PacketRatesAreThoseOfTheManuals) {
  const std::tuple<const char*, double, double> rates[] = {
      {"VLP-16", 754, 1508}, {"VLP-16-HiRes", 754, 1508}, {"HDL-32E", 1808, 3617}, {"VLP-32C", 1507, 3014}};
  for (const auto& [name, single, dual] : rates) {
    EXPECT_NEAR(1.0 / to_seconds(find_model(name)->packet_span(false)), single, 1.0) << name;
    EXPECT_NEAR(1.0 / to_seconds(find_model(name)->packet_span(true)), dual, 1.5) << name;
  }
}

TEST(Models, FiringTimes) {
  const Model& vlp16 = *find_model("VLP-16");
  EXPECT_EQ(vlp16.firing_offset(0, 15, false).count(), 15 * 2304);
  EXPECT_EQ(vlp16.firing_offset(0, 16, false).count(), 55296);
  EXPECT_EQ(vlp16.firing_offset(11, 31, false).count(), 23 * 55296 + 15 * 2304);
  EXPECT_EQ(vlp16.firing_offset(11, 31, true).count(), 11 * 55296 + 15 * 2304);
  EXPECT_EQ(find_model("HDL-32E")->firing_offset(3, 31, false).count(), 3 * 46080 + 31 * 1152);
  EXPECT_EQ(find_model("VLP-32C")->firing_offset(3, 31, false).count(), 3 * 55296 + 15 * 2304);
}

// Firings never go back in time within a packet, and leave the share of its span that DeviceTime counts on.
TEST(Models, FiringsAreOrdered) {
  for (const Model& m : models()) {
    for (const bool dual : {false, true}) {
      Duration last{-1};
      for (int block = 0; block < kBlocks; block += dual ? 2 : 1) {
        for (int slot = 0; slot < kBlockChannels; ++slot) {
          const Duration t = m.firing_offset(block, slot, dual);
          EXPECT_GE(t, last);
          EXPECT_EQ(m.firing_offset(block + (dual ? 1 : 0), slot, dual), t);
          last = t;
        }
      }
      EXPECT_LE(last, DeviceTime::busy_share(m.packet_span(dual)));
    }
  }
}

}  // namespace
}  // namespace cairn::velodyne
