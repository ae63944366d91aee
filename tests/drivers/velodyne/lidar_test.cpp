// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/lidar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/drivers/velodyne/allocation_count.hpp"
#include "tests/support/velodyne_encoder.hpp"

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;
using test::Sensor;

struct Rig {
  explicit Rig(const Config& config = {}) : lidar(Lidar::create(config, SourceId{5}, monitor).value()) {}

  /// Decodes; keeps the scan that came out. False when the packet was refused.
  bool give(const Packet& packet) {
    const auto scan = lidar->decode(packet);
    if (scan && *scan != nullptr) scans.push_back(**scan);
    return scan.has_value();
  }
  void run(Sensor& sensor, Duration duration) {
    for (const auto end = sensor.device_ns + duration.count(); sensor.device_ns < end;) give(sensor.next());
  }
  [[nodiscard]] bool has_event(const std::string& part) const {
    for (const Event& e : monitor.events())
      if (e.what.find(part) != std::string::npos) return true;
    return false;
  }

  Monitor monitor;
  std::unique_ptr<Lidar> lidar;
  std::vector<Scan> scans;
};

Config config_for(const Model& model) {
  Config c;
  c.model = model.name;
  c.max_range_m = 300;
  return c;
}

bool same(const Scan& a, const Scan& b) {
  return a.valid == b.valid && a.cloud.xyz == b.cloud.xyz && a.cloud.intensity == b.cloud.intensity &&
         a.cloud.offset_ns == b.cloud.offset_ns && a.cloud.ring == b.cloud.ring &&
         a.cloud.return_type == b.cloud.return_type && a.incomplete == b.incomplete && a.lost_packets == b.lost_packets;
}

TEST(Lidar, EveryModelAndModeGivesCompleteTurns) {
  for (const Model& model : models()) {
    for (const ReturnMode mode : {ReturnMode::kStrongest, ReturnMode::kLast, ReturnMode::kDual}) {
      Rig rig(config_for(model));
      Sensor sensor;
      sensor.model = &model;
      sensor.mode = mode;
      rig.run(sensor, 550ms);
      ASSERT_EQ(rig.scans.size(), 5U) << model.name;
      EXPECT_EQ(rig.lidar->counters().revolutions, 5U);
      EXPECT_EQ(rig.lidar->counters().lost_packets, 0U);
      EXPECT_NEAR(rig.lidar->counters().rpm, 600, 10);
      for (std::size_t k = 1; k < rig.scans.size(); ++k) {
        const Scan& scan = rig.scans[k];
        EXPECT_FALSE(scan.incomplete);
        EXPECT_EQ(scan.source, SourceId{5});
        EXPECT_NEAR(to_seconds(scan.valid.end - scan.valid.start), 0.1, 2e-4);
        const double firings = 0.1 / to_seconds(model.sequence);
        EXPECT_NEAR(static_cast<double>(scan.cloud.size()), firings * model.channel_count, 2.0 * model.channel_count);
        EXPECT_GT(scan.valid.start, rig.scans[k - 1].valid.end);
      }
    }
  }
}

// A wall of reflectivity 7 between 100° and 101° azimuth: its points must have been fired when the sensor looked there.
TEST(Lidar, StampsAreTheTimesOfTheFirings) {
  Rig rig;
  Sensor sensor;
  sensor.scene = [](double azimuth, int) {
    return DataPacket::Return{2500, static_cast<std::uint8_t>(azimuth > 100 && azimuth < 101 ? 7 : 50)};
  };
  const Time start = sensor.start;
  rig.run(sensor, 1s);
  ASSERT_GT(rig.scans.size(), 5U);
  for (const Scan& scan : rig.scans) {
    int wall = 0;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      if (scan.cloud.intensity[i] != 7) continue;
      ++wall;
      const double t = to_seconds(scan.valid.start + Duration{scan.cloud.offset_ns[i]} - start);
      const double azimuth = std::fmod(t * sensor.rate_deg_s, 360.0);
      ASSERT_GT(azimuth, 99.99);
      ASSERT_LT(azimuth, 101.01);
      const auto& p = scan.cloud.xyz[i];
      ASSERT_NEAR(std::atan2(-p.y(), p.x()) * 180 / std::numbers::pi, azimuth, 0.02);
    }
    EXPECT_GT(wall, 70);
  }
}

TEST(Lidar, LostPacketsAreCountedAndTheirScanIsIncomplete) {
  Rig rig;
  Sensor sensor;
  rig.run(sensor, 250ms);
  for (int i = 0; i < 4; ++i) sensor.skip();
  rig.run(sensor, 300ms);
  EXPECT_EQ(rig.lidar->counters().lost_packets, 4U);
  ASSERT_EQ(rig.scans.size(), 5U);
  for (std::size_t k = 1; k < 5; ++k) {
    EXPECT_EQ(rig.scans[k].lost_packets, k == 2 ? 4U : 0U);
    EXPECT_EQ(rig.scans[k].incomplete, k == 2);
  }
}

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

TEST(Lidar, TimeJumpDiscardsTheRunningScanAndSaysSo) {
  Rig rig;
  Sensor sensor;
  rig.run(sensor, 350ms);
  sensor.device_ns += 1'000'000'000'000;  // PPS found: 1000 s ahead; arrival goes on
  sensor.start -= 1000s;
  rig.run(sensor, 400ms);
  const Counters& c = rig.lidar->counters();
  EXPECT_EQ(c.time_jumps, 1U);
  EXPECT_EQ(c.discarded_scans, 1U);
  EXPECT_EQ(c.lost_packets, 0U);
  EXPECT_TRUE(rig.has_event("device time jumped"));
  Time last = Time::min();
  for (const Scan& scan : rig.scans) {
    EXPECT_GT(scan.valid.start, last);
    EXPECT_LT(scan.valid.end - scan.valid.start, 101ms);
    last = scan.valid.end;
  }
}

TEST(Lidar, SilenceExpiresTheScan) {
  Rig rig;
  Sensor sensor;
  rig.run(sensor, 130ms);
  const Time now = sensor.start + Duration{sensor.device_ns};
  EXPECT_EQ(rig.lidar->expire(now + 100ms), nullptr);
  const Scan* scan = rig.lidar->expire(now + 130ms);
  ASSERT_NE(scan, nullptr);
  EXPECT_TRUE(scan->incomplete);
  EXPECT_EQ(rig.lidar->expire(now + 10s), nullptr);
  EXPECT_EQ(rig.lidar->flush(), nullptr);
}

TEST(Lidar, StandingMotorIsShown) {
  Rig rig;
  Sensor sensor;
  rig.run(sensor, 200ms);
  sensor.rate_deg_s = 0;
  rig.run(sensor, 1s);
  EXPECT_EQ(rig.lidar->counters().rpm, 0);
  EXPECT_LE(rig.lidar->counters().revolutions, 2U);
  EXPECT_GE(rig.scans.size(), 6U);
  for (std::size_t k = 3; k < rig.scans.size(); ++k) EXPECT_TRUE(rig.scans[k].incomplete);
}

TEST(Lidar, OtherSpeedsThanConfiguredNeedNoConfiguration) {
  for (const double hz : {5.0, 8.0, 20.0}) {
    Rig rig;
    Sensor sensor;
    sensor.rate_deg_s = hz * 360;
    rig.run(sensor, from_seconds(4.5 / hz));
    ASSERT_EQ(rig.scans.size(), 4U) << hz;
    for (std::size_t k = 1; k < 4; ++k) {
      EXPECT_FALSE(rig.scans[k].incomplete) << hz;
      EXPECT_NEAR(to_seconds(rig.scans[k].valid.end - rig.scans[k].valid.start), 1 / hz, 2e-4);
    }
  }
}

TEST(Lidar, LimitedFieldOfViewIsNoLoss) {
  Config config;
  config.field_of_view_deg = {300, 60};
  for (const double cut : {0.0, 180.0}) {
    config.cut_angle_deg = cut;
    Rig rig(config);
    Sensor sensor;
    sensor.azimuth_deg = 300;
    for (int turn = 0; turn < 6; ++turn) {
      while (sensor.azimuth_deg >= 300 || sensor.azimuth_deg < 57) rig.give(sensor.next());
      while (sensor.azimuth_deg < 300) sensor.skip();
    }
    EXPECT_EQ(rig.lidar->counters().lost_packets, 0U);
    ASSERT_GE(rig.scans.size(), 5U);
    for (std::size_t k = 1; k < 5; ++k) EXPECT_FALSE(rig.scans[k].incomplete) << cut << " " << k;
  }
}

Packet position(const Sensor& sensor, std::uint8_t pps, const std::string& sentence) {
  Packet packet;
  packet.channel = kDefaultPositionPort;
  packet.arrival = sensor.start + Duration{sensor.device_ns};
  packet.bytes = test::encode_position(static_cast<std::uint32_t>(sensor.device_ns / 1000), pps, sentence);
  return packet;
}

constexpr std::int64_t kNoon = 1'577'880'000;  // 2020-01-01 12:00:00 UTC
const std::string kValid = test::nmea("GPRMC,120000,A,,,,,,,010120,,,A");
const std::string kVoid = test::nmea("GPRMC,120000,V,,,,,,,010120,,,N");

TEST(Lidar, TimeQualityFollowsPpsAndNmea) {
  Rig rig;
  Sensor sensor;
  const auto quality_after = [&](std::uint8_t pps, const std::string& sentence) {
    EXPECT_TRUE(rig.give(position(sensor, pps, sentence)));
    rig.run(sensor, 220ms);
    return rig.scans.back().time_quality;
  };
  EXPECT_EQ(quality_after(0, ""), TimeQuality::kArrival);
  EXPECT_EQ(quality_after(1, kValid), TimeQuality::kArrival);
  EXPECT_EQ(quality_after(2, kVoid), TimeQuality::kArrival);
  EXPECT_EQ(quality_after(2, kValid), TimeQuality::kPpsLocked);
  const auto last_packet_us = (sensor.device_ns - sensor.span().count()) / 1000;
  EXPECT_EQ(rig.lidar->counters().utc_us, kNoon * 1'000'000 + last_packet_us);
  EXPECT_EQ(quality_after(3, kValid), TimeQuality::kArrival);
  EXPECT_FALSE(rig.lidar->counters().utc_us);
  EXPECT_TRUE(rig.has_event("PPS locked"));
  EXPECT_TRUE(rig.has_event("PPS lost"));
  EXPECT_EQ(quality_after(2, kValid), TimeQuality::kPpsLocked);
  rig.run(sensor, 6s);  // the receiver is unplugged
  EXPECT_EQ(rig.scans.back().time_quality, TimeQuality::kArrival);
}

TEST(Lidar, PpsTimeSourceUsesTheSensorsUtcWhereTheHostAgrees) {
  for (const Duration host_error : {Duration(3ms), Duration(2s)}) {
    Config config;
    config.time_source = "pps";
    Rig rig(config);
    Sensor sensor;  // device_ns counts from noon
    rig.lidar->set_utc_offset(std::chrono::seconds(kNoon) - sensor.start.time_since_epoch() + host_error);
    rig.give(position(sensor, 2, kValid));
    rig.run(sensor, 3s);
    const double shift = to_seconds(rig.scans.back().valid.start - sensor.start);
    const double turn = std::round(shift / 0.1) * 0.1;
    // The host's UTC is ahead by the error, so the sensor's UTC means an earlier time on the host's line.
    EXPECT_NEAR(shift - turn, host_error == 3ms ? -0.003 : 0, 1e-4);
    EXPECT_EQ(rig.has_event("differ by more than"), host_error != 3ms);
  }
}

TEST(Lidar, PositionPacketsAreKept) {
  Rig rig;
  Sensor sensor;
  Packet p = position(sensor, 2, kValid);
  p.bytes[kTopBoardTemperatureOffset] = std::byte{55};
  EXPECT_TRUE(rig.give(p));
  EXPECT_TRUE(rig.give(position(sensor, 2, "$GPRMC,broken")));
  p.bytes[kPpsStateOffset] = std::byte{9};
  EXPECT_FALSE(rig.give(p));
  const Counters& c = rig.lidar->counters();
  EXPECT_EQ(c.position_packets, 2U);
  EXPECT_EQ(c.bad_nmea, 1U);
  EXPECT_EQ(c.malformed, 1U);
  EXPECT_EQ(c.nmea->utc_us, kNoon * 1'000'000);
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

TEST(Lidar, DeviceTimeBeyondTheHourIsUsedAndSaid) {
  Rig rig;
  Sensor sensor;
  rig.run(sensor, 10ms);
  for (int i = 0; i < 200; ++i) {
    Packet p = sensor.next();
    auto us = load_le<std::uint32_t>(p.payload(), kTimestampOffset);
    test::store_le(p.bytes, kTimestampOffset, static_cast<std::uint32_t>(us + 3'700'000'000U));
    rig.give(p);
  }
  EXPECT_EQ(rig.lidar->counters().over_the_hour, 200U);
  EXPECT_EQ(rig.lidar->counters().time_jumps, 1U) << "when the device began to do so";
  EXPECT_TRUE(rig.has_event("3600 s"));
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

TEST(Lidar, WarmDecodingAllocatesNothing) {
  for (const ReturnMode mode : {ReturnMode::kStrongest, ReturnMode::kDual}) {
    Rig rig;
    Sensor sensor;
    sensor.mode = mode;
    std::mt19937 random(1);
    sensor.scene = [&](double, int) { return DataPacket::Return{static_cast<std::uint16_t>(random()), 1}; };
    Packet packet;
    rig.run(sensor, 300ms);
    std::size_t allocated = 0, scans = 0;
    for (int i = 0; i < 2000; ++i) {
      sensor.next(packet);
      if (i % 50 == 0) packet.bytes[0] = {};  // refusing allocates nothing either
      const std::size_t before = test::allocation_count();
      {
        const auto scan = rig.lidar->decode(packet);
        scans += scan && *scan != nullptr ? 1 : 0;
      }
      allocated += test::allocation_count() - before;
    }
    EXPECT_GT(scans, 5U);
    EXPECT_EQ(allocated, 0U);
  }
}

// Hostile packets: nothing in a scan is ever infinite, too far, or out of order.
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
    for (std::size_t b = 0; b < kBlocks; ++b) {
      f.azimuth[b] = dual && b % 2 == 1 ? f.azimuth[b - 1] : static_cast<std::uint16_t>(random() % 36000);
      for (auto& r : f.returns[b]) r.distance = static_cast<std::uint16_t>(random());
    }
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
