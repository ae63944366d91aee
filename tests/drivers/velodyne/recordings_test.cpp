// SPDX-License-Identifier: Apache-2.0
// Real recordings, decoded and held against what others found in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "drivers/velodyne/lidar.hpp"
#include "drivers/velodyne/pcap_source.hpp"
#include "hal/bytes.hpp"
#include "hal/file.hpp"

namespace cairn::velodyne {
namespace {

std::filesystem::path data_folder() {
  const char* chosen = std::getenv("CAIRN_DATA");
  return std::filesystem::path(chosen != nullptr ? chosen : CAIRN_SOURCE_DIR "/../shared/data") / "velodyne";
}

#define SKIP_WITHOUT_DATA() \
  if (!std::filesystem::exists(data_folder())) GTEST_SKIP() << "no recordings in " << data_folder()

struct Replay {
  std::vector<Scan> revolutions;  // closed by the cut angle
  std::vector<Scan> scans;        // all
  Counters counters;
  PcapSource::Counters file;
  std::vector<Event> events;
};

Replay replay(const std::string& file, const Config& config) {
  Replay out;
  Monitor monitor;
  auto lidar = Lidar::create(config, SourceId{3}, monitor).value();
  auto source = PcapSource::open(data_folder() / file, {SourceId{3}, {2368, 8308}, {}}).value();
  const auto keep = [&](const Scan* scan) {
    if (scan == nullptr) return;
    out.scans.push_back(*scan);
    if (lidar->counters().revolutions > out.revolutions.size()) out.revolutions.push_back(*scan);
  };
  Packet packet;
  for (;;) {
    const auto poll = source->next(packet, {});
    EXPECT_TRUE(poll.has_value());
    if (!poll || *poll == Poll::kEnd) break;
    const auto scan = lidar->decode(packet);
    EXPECT_TRUE(scan.has_value()) << to_string(scan.error());
    if (scan) keep(*scan);
  }
  keep(lidar->flush());
  out.counters = lidar->counters();
  out.file = source->counters();
  out.events = monitor.events();
  return out;
}

Config config(const std::string& model) {
  Config c;
  c.model = model;
  return c;
}

void expect_sound(const Replay& r, const Config& c) {
  Time last = Time::min();
  for (const Scan& scan : r.scans) {
    EXPECT_EQ(scan.source, SourceId{3});
    EXPECT_GT(scan.valid.start, last);
    EXPECT_GE(scan.valid.end, scan.valid.start);
    last = scan.valid.end;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
      ASSERT_TRUE(scan.cloud.xyz[i].allFinite());
      ASSERT_LE(scan.cloud.xyz[i].norm(), c.max_range_m + 0.02);
      ASSERT_LE(scan.valid.start + Duration{scan.cloud.offset_ns[i]}, scan.valid.end);
    }
    EXPECT_TRUE(std::is_sorted(scan.cloud.offset_ns.begin(), scan.cloud.offset_ns.end()));
  }
}

TEST(Recordings, Vlp16WithGps) {
  SKIP_WITHOUT_DATA();
  const Replay r = replay("vlp16_gps_single_return.pcap", config("VLP-16"));
  expect_sound(r, config("VLP-16"));
  EXPECT_EQ(r.counters.data_packets, 293U);
  EXPECT_EQ(r.counters.position_packets, 57U);
  EXPECT_EQ(r.counters.packets, 350U);
  EXPECT_EQ(r.counters.revolutions, 4U);
  EXPECT_EQ(r.counters.lost_packets, 0U);
  EXPECT_EQ(r.counters.time_jumps, 0U);
  EXPECT_EQ(r.counters.bad_nmea, 0U);
  EXPECT_NEAR(r.counters.rpm, 600, 15);
  EXPECT_EQ(r.counters.pps, PpsState::kLocked);
  ASSERT_TRUE(r.counters.nmea);
  EXPECT_TRUE(r.counters.nmea->valid);
  // 2016-01-21 08:18:02 UTC
  EXPECT_EQ(r.counters.nmea->utc_us, 1453364282LL * 1'000'000);
  EXPECT_EQ(r.scans.back().time_quality, TimeQuality::kPpsLocked);
  // The capturing computer's clock was set by the same receiver to within some 10 ms.
  ASSERT_TRUE(r.counters.utc_us);
  EXPECT_NEAR(1e-6 * static_cast<double>(*r.counters.utc_us), 1453364282.728, 0.5);
}

TEST(Recordings, Hdl32) {
  SKIP_WITHOUT_DATA();
  const Replay r = replay("hdl32_single_return.pcap", config("HDL-32E"));
  expect_sound(r, config("HDL-32E"));
  EXPECT_EQ(r.counters.data_packets, 500U);
  EXPECT_EQ(r.counters.revolutions, 3U);
  EXPECT_EQ(r.counters.lost_packets, 0U);
  EXPECT_EQ(r.counters.time_jumps, 0U);
  for (const Scan& s : r.scans)
    std::printf("%zu points %d lost %u %f\n", s.cloud.size(), s.incomplete, s.lost_packets,
                to_seconds(s.valid.end - s.valid.start));
}

TEST(Recordings, WrongModelIsRefusedWithItsRemedy) {
  SKIP_WITHOUT_DATA();
  Monitor monitor;
  auto lidar = Lidar::create(config("VLP-16"), {}, monitor).value();
  auto source = PcapSource::open(data_folder() / "hdl32_single_return.pcap", {}).value();
  Packet packet;
  std::map<std::string, int> messages;
  while (source->next(packet, {}).value() == Poll::kPacket) {
    const auto scan = lidar->decode(packet);
    ASSERT_FALSE(scan);
    ++messages[to_string(scan.error())];
  }
  EXPECT_EQ(messages.size(), 2U) << "the first with the remedy, the others alike";
  EXPECT_NE(messages.rbegin()->first.find("set model: HDL-32E"), std::string::npos);
  EXPECT_EQ(lidar->counters().wrong_product, 500U);
}

}  // namespace
}  // namespace cairn::velodyne
