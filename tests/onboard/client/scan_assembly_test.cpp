// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/scan_assembly.hpp"

#include <gtest/gtest.h>

namespace cairn::client {
namespace {

clients::ScanPart scan_part(std::int64_t stamp, std::uint32_t total, std::uint32_t first, std::uint32_t count) {
  clients::ScanPart part;
  part.stamp = Time{Duration{stamp}};
  part.total = total;
  part.first = first;
  for (std::uint32_t i = 0; i < count; ++i) part.points_base.emplace_back(static_cast<float>(first + i), 0.F, 0.F);
  return part;
}

TEST(ScanAssembly, PartsMakeAScan) {
  ScanAssembly scans;
  EXPECT_FALSE(scans.take(scan_part(1, 5, 0, 2)));
  EXPECT_FALSE(scans.take(scan_part(1, 5, 2, 2)));
  const auto scan = scans.take(scan_part(1, 5, 4, 1));
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->points_base.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(scan->points_base[i].x(), static_cast<float>(i));
  EXPECT_TRUE(scans.take(scan_part(2, 0, 0, 0)));  // a scan may have no points
}

TEST(ScanAssembly, AScanThatLacksAPartIsLeftOut) {
  ScanAssembly scans;
  EXPECT_FALSE(scans.take(scan_part(1, 5, 0, 2)));
  EXPECT_FALSE(scans.take(scan_part(1, 5, 4, 1)));
  EXPECT_FALSE(scans.take(scan_part(1, 5, 0, 2)));
  EXPECT_FALSE(scans.take(scan_part(2, 5, 2, 3)));
  EXPECT_TRUE(scans.take(scan_part(3, 5, 0, 5)));
}

TEST(ThermalAssembly, PartsMakeACloudAndOneThatLacksAPartIsLeftOut) {
  const auto part = [](std::int64_t stamp, std::uint32_t first) {
    clients::ThermalPart made{.stamp = Time{Duration{stamp}}, .celsius = true, .epoch = 9, .total = 2, .first = first};
    made.points = {{{1, 2, 3}, 20.F + static_cast<float>(first)}};
    return made;
  };
  ThermalAssembly clouds;
  EXPECT_FALSE(clouds.take(part(1, 0)));
  EXPECT_FALSE(clouds.take(part(2, 1)));
  EXPECT_FALSE(clouds.take(part(3, 0)));
  const auto cloud = clouds.take(part(3, 1));
  ASSERT_TRUE(cloud);
  EXPECT_TRUE(cloud->celsius);
  EXPECT_EQ(cloud->epoch, 9U);
  ASSERT_EQ(cloud->points.size(), 2U);
  EXPECT_EQ(cloud->points[1].value, 21);
}

}  // namespace
}  // namespace cairn::client
