// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/scan_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "hal/bytes.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

using ::testing::HasSubstr;

PointCloud random_cloud(std::size_t n) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-100, 100);
  PointCloud cloud;
  for (std::size_t i = 0; i < n; ++i)
    cloud.push_back({any(random), any(random), any(random)}, std::abs(any(random)),
                    static_cast<std::uint32_t>(random() % 100'000'000), 0, ReturnType::kStrongest);
  return cloud;
}

Packet packet_of(std::vector<std::byte> bytes, ScanLayout layout) {
  Packet packet;
  packet.source = SourceId{3};
  packet.channel = static_cast<std::uint16_t>(layout);
  packet.arrival = Time(Duration(5'000'000'000));
  packet.bytes = std::move(bytes);
  return packet;
}

TEST(ScanFile, DecodingIsTheInverseOfEncoding) {
  const PointCloud cloud = random_cloud(1000);
  for (const bool with_offset : {false, true}) {
    ScanFileDecoder decoder(with_offset);
    const auto layout = with_offset ? ScanLayout::kXyziOffset : ScanLayout::kXyzi;
    const auto scan = decoder.decode(packet_of(encode_scan(cloud, with_offset), layout));
    ASSERT_TRUE(scan);
    EXPECT_EQ((*scan)->cloud.xyz, cloud.xyz);
    EXPECT_EQ((*scan)->cloud.intensity, cloud.intensity);
    EXPECT_EQ((*scan)->cloud.ring, std::vector<std::uint8_t>(1000, 0));
    EXPECT_EQ((*scan)->cloud.offset_ns, with_offset ? cloud.offset_ns : std::vector<std::uint32_t>(1000, 0));
    const auto last = *std::max_element((*scan)->cloud.offset_ns.begin(), (*scan)->cloud.offset_ns.end());
    EXPECT_EQ((*scan)->valid.end, Time(Duration(5'000'000'000)));
    EXPECT_EQ((*scan)->valid.start, (*scan)->valid.end - Duration(last));
    EXPECT_EQ((*scan)->deskewed, with_offset);
    EXPECT_EQ((*scan)->source, SourceId{3});
    EXPECT_EQ(decoder.rejected_points(), 0U);
  }
}

TEST(ScanFile, PointsThatAreNoPointsAreLeftOutAndCounted) {
  constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
  PointCloud cloud;
  for (const float bad : {kNan, kInf, -kInf, 1.1e4F})
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3f p(1, 2, 3);
      p[axis] = bad;
      cloud.push_back(p, 0, 0, 0, ReturnType::kStrongest);
    }
  cloud.push_back({1, 2, 3}, kNan, 0, 0, ReturnType::kStrongest);
  cloud.push_back({1, 2, 3}, 0, 2'000'000'001, 0, ReturnType::kStrongest);
  cloud.push_back({1, 2, 3}, 7, 2'000'000'000, 0, ReturnType::kStrongest);
  ScanFileDecoder decoder(false);
  const auto scan = decoder.decode(packet_of(encode_scan(cloud, true), ScanLayout::kXyziOffset));
  ASSERT_TRUE(scan);
  ASSERT_EQ((*scan)->cloud.size(), 1U);
  EXPECT_EQ((*scan)->cloud.intensity[0], 7.0F);
  EXPECT_EQ(decoder.rejected_points(), 14U);
}

TEST(ScanFile, OddSizesAreRefusedAndDecodingGoesOn) {
  ScanFileDecoder decoder(false);
  for (std::size_t n = 1; n < 40; ++n)
    for (const ScanLayout layout : {ScanLayout::kXyzi, ScanLayout::kXyziOffset})
      EXPECT_EQ(decoder.decode(packet_of(std::vector<std::byte>(n), layout)).has_value(),
                n % record_bytes(layout) == 0);
  Packet odd = packet_of({}, ScanLayout::kXyzi);
  odd.channel = 2;
  EXPECT_EQ(decoder.decode(odd).error().code, Errc::kUnsupported);
  Packet cut = packet_of(std::vector<std::byte>(16), ScanLayout::kXyzi);
  cut.truncated = true;
  EXPECT_EQ(decoder.decode(cut).error().code, Errc::kTruncated);
  const Packet large = packet_of(std::vector<std::byte>((kMaxScanPoints + 1) * 16), ScanLayout::kXyzi);
  EXPECT_EQ(decoder.decode(large).error().code, Errc::kLimit);
  EXPECT_EQ(decoder.rejected_packets(), 37U + 38U + 3U);
  EXPECT_TRUE(decoder.decode(packet_of(std::vector<std::byte>(16), ScanLayout::kXyzi)));
}

TEST(ScanIndex, WrittenAndReadAgainIsTheSame) {
  std::vector<ScanIndexEntry> entries, again;
  std::string text(kScanIndexHeader);
  for (int i = 0; i < 100; ++i) {
    entries.push_back({Time(Duration(i * 100'000'000LL - 5)), "scans/" + std::to_string(i) + ".bin",
                       i % 2 == 0 ? ScanLayout::kXyzi : ScanLayout::kXyziOffset});
    text += to_csv(entries.back());
  }
  ASSERT_TRUE(parse_scan_index(text, "data.csv", again));
  ASSERT_EQ(again.size(), entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(again[i].stamp, entries[i].stamp);
    EXPECT_EQ(again[i].file, entries[i].file);
    EXPECT_EQ(again[i].layout, entries[i].layout);
  }
}

TEST(ScanIndex, AFaultNamesItsLineAndWhatWasBeforeIsKept) {
  for (const char* bad : {"2", "x,a.bin", "2,/a.bin", "2,../a.bin", "2,a.bin,2", "2,a.bin,1,0", "1,a.bin", "0,a.bin",
                          "2,", "99999999999999999999,a.bin", "9000000000000000000,a.bin", "2.5,a.bin"}) {
    std::vector<ScanIndexEntry> entries;
    const auto parsed = parse_scan_index(std::string("# c\n1, a.bin \n") + bad + "\n3,b.bin\n", "data.csv", entries);
    ASSERT_FALSE(parsed) << bad;
    EXPECT_EQ(entries.size(), 1U) << bad;
    EXPECT_EQ(entries[0].file, "a.bin");
    EXPECT_THAT(to_string(parsed.error()), HasSubstr("data.csv: offset 14")) << bad;
    EXPECT_THAT(parsed.error().detail, HasSubstr("line 3")) << bad;
  }
}

}  // namespace
}  // namespace cairn::recording
