// SPDX-License-Identifier: Apache-2.0
// Real recordings, decoded and held against what others found in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>

#include "drivers/velodyne/lidar.hpp"
#include "drivers/velodyne/transport/pcap_source.hpp"
#include "hal/bytes.hpp"
#include "hal/files/file.hpp"
#include "tests/support/recorded_data.hpp"

namespace cairn::velodyne {
namespace {

std::filesystem::path data_folder() { return support::recorded_data("velodyne"); }

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

// A revolution is counted where the firings cross the cut angle (0°, forward): the turn that was running when the
// recording began counts, the one that was running when it ended does not.
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
  ASSERT_EQ(r.scans.size(), 4U) << "the start of a turn, two turns, the end of the data";
  EXPECT_TRUE(r.scans[0].incomplete);
  EXPECT_FALSE(r.scans[1].incomplete);
  EXPECT_FALSE(r.scans[2].incomplete);
  EXPECT_TRUE(r.scans[3].incomplete);
}

/// The cloud that another project's decoder gives for one revolution of vlp16_dual_return.pcap.
struct ExpectedPoint {
  float x, y, z;
  std::uint8_t intensity, return_type;
  std::uint16_t channel;
  float azimuth, elevation, distance;
  std::uint32_t time_stamp;
};
static_assert(sizeof(ExpectedPoint) == 32);

std::vector<ExpectedPoint> expected_points() {
  const auto bytes = read_file(data_folder() / "vlp16_dual_return.expected.pcd", 1 << 20).value();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string_view mark = "DATA binary\n";
  const std::span body = std::span(bytes).subspan(text.find(mark) + mark.size());
  std::vector<ExpectedPoint> points(body.size() / sizeof(ExpectedPoint));
  std::memcpy(points.data(), body.data(), points.size() * sizeof(ExpectedPoint));
  return points;
}

/// The other decoder leaves the lasers' vertical offsets out (its z is d·sin(elevation) exactly); ours are up to 11 mm.
Eigen::Vector3f offset_of_ring(std::uint8_t ring) {
  for (const Channel& c : find_model("VLP-16")->channels)
    if (c.ring == ring) return {0, 0, static_cast<float>(c.vertical_offset_m)};
  return {0, 0, 0};
}

/// The other decoder turns by the difference to the next block's azimuth, and the last pair of a dual-return packet has
/// no next: the second firing of that pair keeps the azimuth of the first, 55 µs before.
bool lacks_rotation(const ExpectedPoint& e) {
  constexpr std::uint32_t kSequence = 55'296, kLastPair = 20 * kSequence;  // its times count blocks, not pairs
  return e.time_stamp >= kLastPair && e.time_stamp / kSequence % 2 == 1;
}

std::vector<Eigen::Vector3f> positions(const std::vector<ExpectedPoint>& expected, double repair_deg) {
  const Eigen::AngleAxisf repair(static_cast<float>(-repair_deg * std::numbers::pi / 180), Eigen::Vector3f::UnitZ());
  std::vector<Eigen::Vector3f> out;
  for (const ExpectedPoint& e : expected) {
    const Eigen::Vector3f p(e.x, e.y, e.z);
    out.push_back(lacks_rotation(e) ? repair * p : p);
  }
  return out;
}

/// Squared distance to the nearest of `points`, which ascend in x.
float nearest(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& p) {
  auto right = std::ranges::lower_bound(points, p.x(), {}, [](const auto& q) { return q.x(); });
  auto left = right;
  float best = std::numeric_limits<float>::infinity();
  const auto may_be_nearer = [&](const Eigen::Vector3f& q) { return (q.x() - p.x()) * (q.x() - p.x()) < best; };
  while (left != points.begin() && may_be_nearer(*std::prev(left))) best = std::min(best, (*--left - p).squaredNorm());
  for (; right != points.end() && may_be_nearer(*right); ++right) best = std::min(best, (*right - p).squaredNorm());
  return best;
}

/// Distances in metres to the nearest of our points in the same ring; ascending.
std::vector<double> distances(const std::vector<ExpectedPoint>& expected, const std::vector<Scan>& ours,
                              double repair_deg) {
  std::array<std::vector<Eigen::Vector3f>, 16> rings;
  for (const Scan& s : ours)
    for (std::size_t i = 0; i < s.cloud.size(); ++i)
      rings[s.cloud.ring[i]].push_back(s.cloud.xyz[i] - offset_of_ring(s.cloud.ring[i]));
  for (auto& ring : rings) std::ranges::sort(ring, {}, [](const auto& p) { return p.x(); });
  const auto points = positions(expected, repair_deg);
  std::vector<double> out;
  for (std::size_t i = 0; i < points.size(); ++i)
    out.push_back(std::sqrt(nearest(rings.at(expected[i].channel), points[i])));
  std::sort(out.begin(), out.end());
  return out;
}

double share_within(const std::vector<double>& ascending, double limit) {
  return static_cast<double>(std::upper_bound(ascending.begin(), ascending.end(), limit) - ascending.begin()) /
         static_cast<double>(ascending.size());
}

// Channels of the expected cloud are rings; its frame is REP-103 like ours. It is our last revolution.
TEST(Recordings, Vlp16DualReturnAgreesWithAnotherDecoder) {
  SKIP_WITHOUT_DATA();
  const Replay r = replay("vlp16_dual_return.pcap", config("VLP-16"));
  expect_sound(r, config("VLP-16"));
  EXPECT_EQ(r.counters.data_packets, 603U);
  EXPECT_EQ(r.counters.revolutions, 4U);
  EXPECT_EQ(r.counters.lost_packets, 0U);
  const auto expected = expected_points();
  ASSERT_EQ(expected.size(), 14'831U);
  ASSERT_EQ(r.revolutions.size(), 4U);

  const auto as_is = distances(expected, {r.revolutions.back()}, 0);
  EXPECT_LE(as_is[as_is.size() / 2], 1e-3);  // measured 0.13 mm
  EXPECT_GE(share_within(as_is, 0.02), 0.990);
  const auto in_all = distances(expected, r.scans, 0);
  EXPECT_GE(share_within(in_all, 0.02), 0.9935) << "99.4 %";
  const double turn_per_sequence_deg = r.counters.rpm * 6.0 * to_seconds(find_model("VLP-16")->sequence);
  const auto repaired = distances(expected, {r.revolutions.back()}, turn_per_sequence_deg);
  EXPECT_LE(repaired[repaired.size() / 2], 1e-3);
  EXPECT_GE(share_within(repaired, 0.02), 0.999);
  EXPECT_LE(repaired.back(), 0.035);
}

// The last return is never nearer than the strongest, or than the second strongest where the strongest is the last: so
// the even block of a pair is the last.
TEST(Recordings, EvenBlocksOfADualReturnPacketHoldTheLastReturn) {
  SKIP_WITHOUT_DATA();
  auto source = PcapSource::open(data_folder() / "vlp16_dual_return.pcap", {}).value();
  Packet packet;
  int nearer = 0, farther = 0;
  while (source->next(packet, {}).value() == Poll::kPacket) {
    const DataPacket data = parse_data_packet(packet.payload(), *find_model("VLP-16")).value();
    for (int block = 0; block < kBlocks; block += 2) {
      for (int slot = 0; slot < kBlockChannels; ++slot) {
        const int even = data.at(block, slot).distance, odd = data.at(block + 1, slot).distance;
        nearer += even != 0 && odd != 0 && even < odd ? 1 : 0;
        farther += even != 0 && odd != 0 && even > odd ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(nearer, 0);
  EXPECT_GT(farther, 500);
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
