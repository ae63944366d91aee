// SPDX-License-Identifier: Apache-2.0
// Device time, PPS and position packets, seen from the whole lidar.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/drivers/velodyne/lidar_rig.hpp"

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;
using test::Rig;
using test::Sensor;

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

TEST(Lidar, PacketsThatAreHeldUpStillMakeWholeScans) {
  Rig rig;
  Sensor sensor;
  const auto run = [&](Duration duration) {
    for (const auto end = sensor.device_ns + duration.count(); sensor.device_ns < end;) {
      const Packet packet = sensor.next();
      rig.give(packet);
      if (const Scan* scan = rig.lidar->expire(packet.arrival)) rig.scans.push_back(*scan);
    }
  };
  run(350ms);
  sensor.start += 600ms;
  run(700ms);
  EXPECT_LE(rig.scans.size(), 11U);
  for (std::size_t k = 1; k < rig.scans.size(); ++k) EXPECT_FALSE(rig.scans[k].incomplete) << k;
  EXPECT_NE(rig.lidar->expire(sensor.start + Duration{sensor.device_ns} + 160ms), nullptr) << "then silence";
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

/// The pulse of each second comes to the computer as well. Then neither the network's delay nor the host's UTC counts.
TEST(Lidar, PulsesAtTheComputerSetTheStamps) {
  for (const bool utc_known : {false, true}) {
    Config config;
    config.time_source = "pps";
    Rig rig(config);
    Sensor sensor;  // device_ns counts from noon, and noon is a whole second
    if (utc_known) rig.lidar->set_utc_offset(std::chrono::seconds(kNoon) - sensor.start.time_since_epoch() + 80ms);
    rig.give(position(sensor, 2, kValid));
    for (int second = 0; second < 3; ++second) {
      rig.lidar->note_second(sensor.start + std::chrono::seconds(second) -
                             4ms);  // what the sensor calls noon is earlier
      rig.run(sensor, 1s);
    }
    const double shift = to_seconds(rig.scans.back().valid.start - sensor.start);
    EXPECT_NEAR(shift - std::round(shift / 0.1) * 0.1, -0.004, 1e-4) << utc_known;
  }
}

TEST(Lidar, WithoutTheTimeSourcePulsesChangeNothing) {
  Rig rig;
  Sensor sensor;
  rig.give(position(sensor, 2, kValid));
  rig.lidar->note_second(sensor.start - 40ms);
  rig.run(sensor, 1s);
  const double shift = to_seconds(rig.scans.back().valid.start - sensor.start);
  EXPECT_NEAR(shift - std::round(shift / 0.1) * 0.1, 0, 1e-3);
}

TEST(Lidar, AFixIsGivenOnce) {
  Rig rig;
  Sensor sensor;
  const auto said = [](const std::string& time, char status) {
    return test::nmea("GPRMC," + time + "," + status + ",5155.4400,N,00424.1200,E,0,0,010120,,,A");
  };
  EXPECT_FALSE(rig.lidar->take_fix());
  for (int again = 0; again < 3; ++again) rig.give(position(sensor, 2, said("120000", 'A')));
  const auto fix = rig.lidar->take_fix();
  ASSERT_TRUE(fix);
  EXPECT_NEAR(fix->latitude_deg, 51.924, 1e-9);
  EXPECT_NEAR(fix->longitude_deg, 4.402, 1e-9);
  EXPECT_FALSE(rig.lidar->take_fix());
  rig.give(position(sensor, 2, said("120000", 'A')));
  EXPECT_FALSE(rig.lidar->take_fix()) << "the same second";
  rig.give(position(sensor, 2, said("120001", 'V')));
  EXPECT_FALSE(rig.lidar->take_fix()) << "not valid";
  rig.give(position(sensor, 0, said("120002", 'A')));
  EXPECT_TRUE(rig.lidar->take_fix()) << "a place needs no lock of the clock";
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

}  // namespace
}  // namespace cairn::velodyne
