// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/pcd_file.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <random>
#include <string_view>

#include "hal/bytes.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

using test::bytes_of;
using ::testing::HasSubstr;

std::string header(const std::string& fields, const std::string& size, const std::string& type, std::size_t points,
                   const std::string& data) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nWIDTH " + n +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

PointCloud random_cloud(std::size_t n) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-100, 100);
  PointCloud cloud;
  for (std::size_t i = 0; i < n; ++i)
    cloud.push_back({any(random), any(random), any(random)}, std::abs(any(random)),
                    i == 0 ? 0 : static_cast<std::uint32_t>(random() % 100'000'000),
                    static_cast<std::uint8_t>(random() % 16), ReturnType::kStrongest);
  return cloud;
}

TEST(Pcd, WrittenAndReadAgainIsTheSame) {
  const PointCloud cloud = random_cloud(500);
  const auto again = parse_pcd(to_pcd(cloud), "f.pcd");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_EQ(again->cloud.xyz, cloud.xyz);
  EXPECT_EQ(again->cloud.intensity, cloud.intensity);
  EXPECT_EQ(again->cloud.ring, cloud.ring);
  EXPECT_TRUE(again->has_time);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    EXPECT_NEAR(again->cloud.offset_ns[i], cloud.offset_ns[i], 8) << "a float has 24 bits for 0.1 s";
}

TEST(Pcd, ColumnsOfAnyNameAreWritten) {
  const std::array<std::string_view, 4> fields{"x", "y", "z", "temperature"};
  const std::array<float, 8> values{1, 2, 3, 20.5F, 4, 5, 6, 36};
  const auto file = to_pcd(fields, values);
  const auto header = parse_pcd_header(file, "f.pcd");
  ASSERT_TRUE(header) << to_string(header.error());
  EXPECT_EQ(header->points, 2U);
  EXPECT_EQ(header->point_bytes, 16U);
  ASSERT_NE(header->field("temperature"), nullptr);
  EXPECT_EQ(header->field("temperature")->offset, 12U);
  float last = 0;
  std::memcpy(&last, file.data() + file.size() - sizeof last, sizeof last);
  EXPECT_EQ(last, 36);
  const auto cloud = parse_pcd(file, "f.pcd");
  ASSERT_TRUE(cloud) << to_string(cloud.error());
  EXPECT_EQ(cloud->cloud.xyz[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(parse_pcd_header(to_pcd(fields, {}), "f.pcd")->points, 0U);
}

TEST(Pcd, EveryTypeOfFieldIsRead) {
  std::vector<std::byte> bytes =
      test::to_bytes(header("u1 i1 u2 i2 u4 i4 u8 i8 x y z intensity pad", "1 1 2 2 4 4 8 8 8 4 2 1 4",
                            "U I U I U I U I F F I U F", 1, "binary"));
  append_le<std::uint8_t>(bytes, 200);
  append_le<std::int8_t>(bytes, -100);
  append_le<std::uint16_t>(bytes, 1);
  append_le<std::int16_t>(bytes, 2);
  append_le<std::uint32_t>(bytes, 3);
  append_le<std::int32_t>(bytes, 4);
  append_le<std::uint64_t>(bytes, 5);
  append_le<std::int64_t>(bytes, 6);
  append_le<double>(bytes, 1.25);
  append_le<float>(bytes, 2.5F);
  append_le<std::int16_t>(bytes, -3);
  append_le<std::uint8_t>(bytes, 200);
  append_le<float>(bytes, 0);
  const auto pcd = parse_pcd(bytes, "f");
  ASSERT_TRUE(pcd) << to_string(pcd.error());
  EXPECT_EQ(pcd->cloud.xyz[0], Eigen::Vector3f(1.25F, 2.5F, -3));
  EXPECT_EQ(pcd->cloud.intensity[0], 200.0F);
  EXPECT_FALSE(pcd->has_time);
}

TEST(Pcd, AsciiWithColumnsOfSeveralValues) {
  const std::string text =
      "VERSION .7\nFIELDS normal x y z ring t\nSIZE 4 4 4 4 2 4\nTYPE F F F F U U\nCOUNT 3 1 1 1 1 1\n"
      "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n0 0 1 1.5 2.5 -3 4 2000\n0 0 1 7 8 9 15 1000\n";
  const auto pcd = parse_pcd(bytes_of(text), "f");
  ASSERT_TRUE(pcd) << to_string(pcd.error());
  EXPECT_EQ(pcd->cloud.xyz[0], Eigen::Vector3f(1.5F, 2.5F, -3));
  EXPECT_EQ(pcd->cloud.ring, (std::vector<std::uint8_t>{4, 15}));
  EXPECT_EQ(pcd->cloud.offset_ns, (std::vector<std::uint32_t>{1000, 0}));
}

TEST(Pcd, AsciiAndBinarySayTheSame) {
  const PointCloud cloud = random_cloud(100);
  std::string text = header("x y z", "4 4 4", "F F F", 100, "ascii");
  for (const auto& p : cloud.xyz)
    text += std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\r\n";
  const auto pcd = parse_pcd(bytes_of(text), "f");
  ASSERT_TRUE(pcd);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_LT((pcd->cloud.xyz[i] - cloud.xyz[i]).norm(), 1e-5F);
}

TEST(Pcd, TimesOfSeveralConventions) {
  const auto offsets = [](const std::string& field, const std::string& size, const std::string& type,
                          const std::string& first, const std::string& second) {
    const std::string text = header("x y z " + field, "4 4 4 " + size, "F F F " + type, 2, "ascii") + "1 1 1 " + first +
                             "\n1 1 1 " + second + "\n";
    return parse_pcd(bytes_of(text), "f");
  };
  const std::vector<std::uint32_t> expected{0, 50'000'000};
  const auto before_the_stamp = offsets("time", "4", "F", "-0.05", "0");
  const auto ouster = offsets("t", "4", "U", "100", "50000100");
  const auto epoch = offsets("timestamp", "8", "F", "1700000000.25", "1700000000.3");
  const auto livox = offsets("timestamp", "8", "F", "1700000000250000000", "1700000000300000000");
  for (const auto* pcd : {&before_the_stamp, &ouster, &epoch, &livox}) {
    ASSERT_TRUE(*pcd) << to_string(pcd->error());
    EXPECT_NEAR((*pcd)->cloud.offset_ns[1], expected[1], 300);
  }
  EXPECT_FALSE(before_the_stamp->end_utc_ns);
  EXPECT_FALSE(ouster->end_utc_ns);
  EXPECT_NEAR(static_cast<double>(*epoch->end_utc_ns), 1.7000000003e18, 300);
  EXPECT_NEAR(static_cast<double>(*livox->end_utc_ns), 1.7000000003e18, 300);
  EXPECT_FALSE(offsets("time", "4", "F", "0", "2.1"));
  EXPECT_FALSE(offsets("timestamp", "8", "F", "-1e300", "1e300"));
}

TEST(Pcd, PointsThatAreNoPointsAreLeftOutAndCounted) {
  const std::string text =
      header("x y z", "4 4 4", "F F F", 5, "ascii") + "1 2 3\nnan nan nan\ninf 0 0\n2e4 0 0\n4 5 6\n";
  const auto pcd = parse_pcd(bytes_of(text), "f");
  ASSERT_TRUE(pcd);
  EXPECT_EQ(pcd->cloud.size(), 2U);
  EXPECT_EQ(pcd->rejected, 3U);
}

TEST(Pcd, FaultsAreNamed) {
  const auto fault = [](const std::string& text) {
    const auto pcd = parse_pcd(bytes_of(text), "f.pcd");
    return pcd ? std::string("none") : to_string(pcd.error());
  };
  EXPECT_THAT(fault(header("x y z", "4 4 4", "F F F", 1, "binary_compressed")),
              HasSubstr("compressed PCD files are not read"));
  EXPECT_THAT(fault(header("x y z", "4 4 4", "F F F", 1, "zip")), HasSubstr("DATA must be"));
  EXPECT_THAT(fault(header("x y z", "4 4", "F F F", 1, "ascii")), HasSubstr("must list the same fields"));
  EXPECT_THAT(fault(header("x y z", "4 4 3", "F F F", 1, "ascii")), HasSubstr("impossible SIZE"));
  EXPECT_THAT(fault(header("x y z", "4 4 2", "F F F", 1, "ascii")), HasSubstr("impossible SIZE"));
  EXPECT_THAT(fault(header("x y z", "4 4 4", "F F Q", 1, "ascii")), HasSubstr("impossible SIZE"));
  EXPECT_THAT(fault(header("x y w", "4 4 4", "F F F", 0, "ascii")), HasSubstr("no fields x, y and z"));
  EXPECT_THAT(fault(header("x y z", "4 4 4", "F F F", 2, "ascii") + "1 2 3\n"), HasSubstr("1 of 2 points"));
  EXPECT_THAT(fault(header("x y z", "4 4 4", "F F F", 2, "ascii") + "1 2 3\n4 5\n"),
              HasSubstr("too few values: line 2"));
  EXPECT_THAT(fault(header("x y z", "4 4 4", "F F F", 2, "binary") + std::string(23, 'a')), HasSubstr("1 of 2 points"));
  EXPECT_THAT(fault(header("x y z", "4 4 4", "F F F", 3'000'000, "binary")), HasSubstr("too many points"));
  EXPECT_THAT(fault("GIF89a"), HasSubstr("not a line of a PCD header: line 1"));
  EXPECT_THAT(fault(""), HasSubstr("no DATA line"));
  EXPECT_THAT(fault("FIELDS x\nSIZE 4\nTYPE F\nWIDTH 99999999999999999999\n"), HasSubstr("not a usable number"));
  EXPECT_THAT(fault("FIELDS x\nSIZE 4\nTYPE F\nWIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA ascii\n"), HasSubstr("POINTS must"));
}

TEST(Pcd, CutAtEveryByteIsAnErrorNeverACrash) {
  const std::string whole = text_of(to_pcd(random_cloud(4)));
  for (std::size_t n = 0; n < whole.size(); ++n)
    EXPECT_FALSE(parse_pcd(bytes_of(std::string_view(whole).substr(0, n)), "f")) << n;
  EXPECT_TRUE(parse_pcd(bytes_of(whole), "f"));
}

}  // namespace
}  // namespace cairn::recording
