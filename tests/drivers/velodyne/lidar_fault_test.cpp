// SPDX-License-Identifier: Apache-2.0
// What the network and the sensor do wrong, seen from the whole lidar.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/drivers/velodyne/lidar_rig.hpp"
#include "tests/drivers/velodyne/random_azimuths.hpp"

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;
using test::Rig;
using test::same;
using test::Sensor;

TEST(Lidar, DuplicatesAndOvertakenPacketsChangeNothing) {
  Rig clean, dirty;
  Sensor sensor;
  Packet previous;
  int extra = 0;
  for (int i = 0; i < 400; ++i) {
    const Packet packet = sensor.next();
    EXPECT_TRUE(clean.give(packet));
    EXPECT_TRUE(dirty.give(packet));
    if (i % 3 == 0) {
      EXPECT_FALSE(dirty.give(packet));
      ++extra;
    }
    if (i % 5 == 4) {
      EXPECT_FALSE(dirty.give(previous));
      ++extra;
    }
    previous = packet;
  }
  ASSERT_EQ(clean.scans.size(), dirty.scans.size());
  for (std::size_t k = 0; k < clean.scans.size(); ++k) EXPECT_TRUE(same(clean.scans[k], dirty.scans[k]));
  const Counters& c = dirty.lidar->counters();
  EXPECT_EQ(c.duplicates + c.late, static_cast<std::uint64_t>(extra));
  EXPECT_EQ(c.time_jumps, 0U);
}

TEST(Lidar, TwoPacketsThatChangePlacesCostOne) {
  Rig rig;
  Sensor sensor;
  rig.run(sensor, 50ms);
  const Packet first = sensor.next(), second = sensor.next();
  EXPECT_TRUE(rig.give(second));
  EXPECT_FALSE(rig.give(first));
  rig.run(sensor, 100ms);
  EXPECT_EQ(rig.lidar->counters().lost_packets, 1U);
  EXPECT_EQ(rig.lidar->counters().late, 1U);
}

TEST(Lidar, DamagedPacketsAreRefusedWholeAndCountedByCause) {
  Rig rig;
  Sensor sensor;
  const auto refuse = [&](auto damage) {
    Packet packet = sensor.next();
    damage(packet);
    EXPECT_FALSE(rig.give(packet));
  };
  rig.run(sensor, 10ms);
  refuse([](Packet& p) { p.truncated = true; });
  refuse([](Packet& p) { p.bytes.pop_back(); });
  refuse([](Packet& p) { p.bytes.assign(512, {}); });  // a position packet on the data port
  refuse([](Packet& p) { p.bytes[0] = {}; });
  refuse([](Packet& p) { p.bytes[kProductOffset] = std::byte{0x21}; });
  refuse([](Packet& p) { p.channel = 8308; });  // a data packet on the position port
  refuse([](Packet& p) { p.channel = 9; });
  refuse([](Packet& p) { p.arrival = Time::max(); });
  const Counters& c = rig.lidar->counters();
  EXPECT_EQ(c.truncated, 1U);
  EXPECT_EQ(c.wrong_length, 3U);
  EXPECT_EQ(c.malformed, 2U);
  EXPECT_EQ(c.wrong_product, 1U);
  EXPECT_EQ(c.wrong_port, 1U);
  EXPECT_EQ(c.packets, c.data_packets + 8);
  rig.run(sensor, 10ms);
  EXPECT_EQ(c.lost_packets, 8U) << "what was refused is missing";
}

TEST(Lidar, WrongReturnModeIsOneEvent) {
  Config config;
  config.return_mode = "dual";
  Rig rig(config);
  Sensor sensor;
  rig.run(sensor, 300ms);
  ASSERT_EQ(rig.monitor.events().size(), 1U);
  EXPECT_EQ(rig.monitor.events()[0].count, 1U);
  EXPECT_TRUE(rig.has_event("return mode strongest, configured is dual"));
  EXPECT_FALSE(rig.scans.empty());
}

TEST(Lidar, BadConfigurationIsRefused) {
  Monitor monitor;
  Config config;
  config.model = "HDL-64E";
  const auto lidar = Lidar::create(config, {}, monitor);
  ASSERT_FALSE(lidar);
  EXPECT_EQ(lidar.error().code, Errc::kInvalidConfig);
}

TEST(Lidar, RandomPacketsNeverBreakAScan) {
  std::mt19937_64 random(11);
  Rig rig;
  Time last = Time::min();
  const auto check = [&](const Scan& scan) {
    ASSERT_GT(scan.valid.start, last);
    last = scan.valid.end;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      ASSERT_TRUE(scan.cloud.xyz[i].allFinite());
      ASSERT_LE(scan.cloud.xyz[i].norm(), 130.02F);
      ASSERT_LE(scan.valid.start + Duration{scan.cloud.offset_ns[i]}, scan.valid.end);
    }
    ASSERT_TRUE(std::is_sorted(scan.cloud.offset_ns.begin(), scan.cloud.offset_ns.end()));
  };
  Time arrival{1000s};
  for (int i = 0; i < 3000; ++i) {
    test::DataFields f;
    const bool steady = random() % 8 != 0;
    f.timestamp_us = steady ? static_cast<std::uint32_t>(i * 1327) : static_cast<std::uint32_t>(random());
    const bool dual = random() % 4 == 0;
    f.mode = dual ? 0x39 : 0x37;
    f.azimuth = test::random_azimuths(dual, random);
    for (auto& block : f.returns)
      for (auto& r : block) r.distance = static_cast<std::uint16_t>(random());
    Packet packet;
    packet.channel = kDefaultDataPort;
    arrival +=
        steady ? Duration{1'327'104} : Duration{static_cast<std::int64_t>(random() % 4'000'000'000) - 2'000'000'000};
    packet.arrival = arrival;
    packet.bytes = encode(f);
    rig.scans.clear();
    rig.give(packet);
    for (const Scan& scan : rig.scans) check(scan);
    if (random() % 100 == 0)
      if (const Scan* scan = rig.lidar->expire(arrival)) check(*scan);
  }
  EXPECT_GT(rig.lidar->counters().scans, 10U);
}

}  // namespace
}  // namespace cairn::velodyne
