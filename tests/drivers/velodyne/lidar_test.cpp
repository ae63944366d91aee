// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/lidar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/drivers/velodyne/lidar_rig.hpp"
#include "tests/support/allocation_count.hpp"

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;
using test::config_for;
using test::Rig;
using test::Sensor;

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
      const std::size_t before = support::allocation_count();
      {
        const auto scan = rig.lidar->decode(packet);
        scans += scan && *scan != nullptr ? 1 : 0;
      }
      allocated += support::allocation_count() - before;
    }
    EXPECT_GT(scans, 5U);
    EXPECT_EQ(allocated, 0U);
  }
}

// Hostile packets: nothing in a scan is ever infinite, too far, or out of order.

}  // namespace
}  // namespace cairn::velodyne
