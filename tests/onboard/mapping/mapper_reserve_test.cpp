// SPDX-License-Identifier: Apache-2.0
// MappingConfig::reserve_mb
#include <gtest/gtest.h>

#include <vector>

#include "onboard/mapping/mapper.hpp"
#include "tests/onboard/mapping/scan_yard.hpp"
#include "tests/support/allocation_count.hpp"
#include "tests/support/rounds.hpp"

namespace cairn::mapping {
namespace {

MappingConfig reserving_32_mb() {
  MappingConfig config;
  config.resolution_m = 0.2;
  config.max_range_m = 20;
  config.reserve_mb = 32;
  config.spare_surfaces = false;
  return config;
}

TEST(MapperReserve, NewGroundWithinTheReserveIsMappedWithoutAllocating) {
  Workers workers(2);
  const MappingConfig config = reserving_32_mb();
  Mapper mapper(config, workers);
  const ScanYard yard(support::rounds(900, 150));
  std::vector<MapScan> scans;
  for (int i = 0; i < 12; ++i) scans.push_back(yard.scan(6 * i));
  for (std::size_t i = 0; i < 2; ++i) ASSERT_TRUE(mapper.insert(scans[i].points, scans[i].origin));
  const std::size_t before = support::allocation_count();
  for (std::size_t i = 2; i < scans.size(); ++i) ASSERT_TRUE(mapper.insert(scans[i].points, scans[i].origin));
  EXPECT_EQ(support::allocation_count() - before, 0U);
}

TEST(MapperReserve, TheReserveIsTakenOnceAndAtTheStart) {
  Workers workers(1);
  const MappingConfig config = reserving_32_mb();
  Mapper mapper(config, workers);
  const std::size_t reserved = mapper.tree().memoryUsage();
  EXPECT_GE(reserved, std::size_t{32} << 20U);
  const auto nothing = mapper.begin_anew();  // with the first scan of a run
  EXPECT_EQ(nothing->size(), 0U);
  EXPECT_LT(nothing->memoryUsage(), std::size_t{1} << 20U);
  EXPECT_EQ(mapper.tree().memoryUsage(), reserved);
  const ScanYard yard(support::rounds(900, 150));
  ASSERT_TRUE(mapper.insert(yard.scan(0).points, yard.scan(0).origin));
  const auto first = mapper.begin_anew();
  EXPECT_GT(first->size(), 0U);
  EXPECT_EQ(first->memoryUsage(), reserved);
  EXPECT_EQ(mapper.tree().size(), 0U);
  EXPECT_LT(mapper.tree().memoryUsage(), std::size_t{1} << 20U) << "a later map takes memory when it needs it";
  ASSERT_TRUE(mapper.insert(yard.scan(0).points, yard.scan(0).origin));
  EXPECT_EQ(mapper.tree().size(), first->size());
}

}  // namespace
}  // namespace cairn::mapping
