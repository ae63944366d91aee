// SPDX-License-Identifier: Apache-2.0
// The oracle is octomap::OcTree::insertPointCloud(): after every scan the trees must be equal node by node, bit by bit.
#include "onboard/mapping/mapper.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <limits>
#include <set>

#include "tests/onboard/mapping/insert/scan_cases.hpp"
#include "tests/onboard/mapping/kitti_scans.hpp"
#include "tests/onboard/mapping/scan_yard.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/allocation_count.hpp"
#include "tests/support/rounds.hpp"

namespace cairn::mapping {
namespace {

octomap::Pointcloud to_octomap(std::span<const Eigen::Vector3f> points) {
  octomap::Pointcloud cloud;
  for (const Eigen::Vector3f& p : points) cloud.push_back(p.x(), p.y(), p.z());
  return cloud;
}

void insert_into(octomap::OcTree& stock, const MapScan& scan, double max_range) {
  stock.insertPointCloud(to_octomap(scan.points), {scan.origin.x(), scan.origin.y(), scan.origin.z()}, max_range, false,
                         true);
}

/// OctoMap's, or with spared surfaces.
MappingConfig config_of(double resolution, double max_range, bool spare_surfaces = false) {
  return {.resolution_m = resolution, .max_range_m = max_range, .spare_surfaces = spare_surfaces};
}

struct Setting {
  const char* name;
  double resolution, max_range;
  unsigned threads;
  int azimuths, scans;
};

class MapperOracle : public testing::TestWithParam<Setting> {};

TEST_P(MapperOracle, GivesOctoMapsTreeAfterEveryScan) {
  const Setting& s = GetParam();
  Workers workers(s.threads);
  Mapper mapper(config_of(s.resolution, s.max_range), workers);
  octomap::OcTree stock(s.resolution);
  const ScanYard yard(support::rounds(s.azimuths, s.azimuths / 6));
  for (int i = 0; i < s.scans; ++i) {
    const MapScan scan = yard.scan(3 * i);
    ASSERT_TRUE(mapper.insert(scan.points, scan.origin));
    insert_into(stock, scan, s.max_range);
    ASSERT_EQ(differing_nodes(mapper.tree(), stock), 0U) << "scan " << i;
  }
  EXPECT_EQ(data_of(mapper.tree()), data_of(stock));
  EXPECT_TRUE(mapper.tree().is_canonical());
}

INSTANTIATE_TEST_SUITE_P(Settings, MapperOracle,
                         testing::Values(Setting{"usual", 0.2, 30, 1, 900, 4}, Setting{"fine", 0.1, 10, 1, 150, 4},
                                         Setting{"unlimited", 0.25, -1, 1, 300, 5},
                                         Setting{"two_threads", 0.25, 30, 2, 300, 5},
                                         Setting{"short_range", 0.5, 5, 3, 600, 10}),
                         [](const auto& i) { return std::string(i.param.name); });

class MapperKitti : public testing::TestWithParam<Setting> {};

TEST_P(MapperKitti, GivesOctoMapsTreeOverRealScans) {
  const Setting& s = GetParam();
  const std::vector<MapScan> scans = kitti_scans(s.scans, support::rounds(1, 10));
  if (scans.empty()) GTEST_SKIP() << "no recording at " << kitti_recording();
  Workers workers(s.threads);
  Mapper mapper(config_of(s.resolution, s.max_range), workers);
  octomap::OcTree stock(s.resolution);
  for (const MapScan& scan : scans) {
    ASSERT_TRUE(mapper.insert(scan.points, scan.origin));
    insert_into(stock, scan, s.max_range);
    ASSERT_EQ(differing_nodes(mapper.tree(), stock), 0U);
  }
  EXPECT_EQ(data_of(mapper.tree()), data_of(stock));
}

INSTANTIATE_TEST_SUITE_P(Settings, MapperKitti, testing::Values(Setting{"two_scans", 0.2, 30, 2, 0, 2}),
                         [](const auto& i) { return std::string(i.param.name); });
INSTANTIATE_TEST_SUITE_P(FullSettings, MapperKitti,
                         testing::Values(Setting{"coarse", 0.2, 30, 2, 0, 5}, Setting{"fine", 0.1, 20, 1, 0, 2}),
                         [](const auto& i) { return std::string(i.param.name); });

void expect_octomaps_ties(unsigned seeds, int scans) {
  for (unsigned seed = 0; seed < seeds; ++seed)
    EXPECT_EQ(ScanCase(seed, scans).run(1 + seed % 3), "") << "seed " << seed;
}

TEST(MapperLattice, TiesAndEdgesAreDecidedAsOctoMapDecidesThem) { expect_octomaps_ties(6, support::rounds(6, 2)); }
TEST(FullMapperLattice, TiesAndEdgesAreDecidedAsOctoMapDecidesThem) { expect_octomaps_ties(20, 6); }

TEST(MapperLattice, HugeBoxesAreFoundByHashing) {
  MappingConfig config = config_of(0.1, -1);
  Workers workers(2);
  Mapper mapper(config, workers);
  octomap::OcTree stock(0.1);
  // The second scan spans 3 km by 3 km by 3 km; a flat table of its bricks would take gigabytes.
  const std::vector<MapScan> scans{{{{10, 0, 0}, {0, 7, 1}}, {0.05F, 0.05F, 0.05F}},
                                   {{{1500, 1, 2}, {3, -1500, 1}, {2, 2, 1500}}, {-900.0F, 1000.0F, -1500.0F}}};
  for (const MapScan& scan : scans) {
    ASSERT_TRUE(mapper.insert(scan.points, scan.origin));
    insert_into(stock, scan, -1);
    EXPECT_EQ(differing_nodes(mapper.tree(), stock), 0U);
  }
}

TEST(Mapper, IsTheSameForAnyNumberOfThreads) {
  const ScanYard yard(support::rounds(400, 100));
  std::string first;
  std::vector<TileKey> tiles;
  for (const unsigned threads : {1U, 2U, 3U, 5U}) {
    Workers workers(threads);
    Mapper mapper(config_of(0.2, 30, true), workers);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(mapper.insert(yard.scan(i).points, yard.scan(i).origin));
    if (threads == 1) {
      first = data_of(mapper.tree());
      tiles = mapper.take_changed_tiles();
    }
    EXPECT_EQ(data_of(mapper.tree()), first);
    EXPECT_TRUE(threads == 1 || mapper.take_changed_tiles() == tiles);
  }
}

TEST(Mapper, CountsAndLeavesOutWhatIsNotInTheMap) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  Workers workers(1);
  Mapper with(config_of(0.1, 30), workers), without(config_of(0.1, 30), workers);
  const std::vector<Eigen::Vector3f> good{{1, 2, 3}, {4, -5, 1}};
  const std::vector<Eigen::Vector3f> all{{nan, 0, 0}, good[0],          {0, infinity, 0}, {3276.9F, 0, 0},
                                         good[1],     {0, 0, -3276.9F}, {1e30F, 0, 0},    {0, -nan, 1e30F}};
  const auto report = with.insert(all, {0, 0, 0});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->points, 8U);
  EXPECT_EQ(report->not_finite, 3U);
  EXPECT_EQ(report->outside_map, 3U);
  EXPECT_EQ(report->rays, 2U);
  ASSERT_TRUE(without.insert(good, {0, 0, 0}));
  EXPECT_EQ(data_of(with.tree()), data_of(without.tree()));
}

TEST(Mapper, RefusesAnOriginOutsideOfTheMap) {
  Workers workers(1);
  Mapper mapper(config_of(0.1, 30), workers);
  const std::vector<Eigen::Vector3f> points{{1, 2, 3}};
  for (const float x : {3300.0F, -3300.0F, std::numeric_limits<float>::quiet_NaN()}) {
    const auto report = mapper.insert(points, {x, 0, 0});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, Errc::kLimit);
  }
  EXPECT_EQ(mapper.tree().size(), 0U);
}

TEST(Mapper, AnEmptyScanChangesNothing) {
  Workers workers(1);
  Mapper mapper(config_of(0.1, 30), workers);
  ASSERT_TRUE(mapper.insert({}, {0, 0, 0}));
  EXPECT_EQ(mapper.tree().size(), 0U);
  EXPECT_TRUE(mapper.changed_tiles().empty());
}

/// A sphere of points as far as the map goes: every ray is short of the limit, all together are not.
std::vector<Eigen::Vector3f> sphere(int points, float radius) {
  std::vector<Eigen::Vector3f> out;
  for (int i = 0; i < points; ++i) {
    const float z = 2 * (static_cast<float>(i) + 0.5F) / static_cast<float>(points) - 1;
    const float a = 2.4F * static_cast<float>(i), r = std::sqrt(1 - z * z);
    out.emplace_back(radius * Eigen::Vector3f(r * std::cos(a), r * std::sin(a), z));
  }
  return out;
}

TEST(Mapper, RefusesScansThatTouchTooMuchAndKeepsTheMap) {
  Workers workers(2);
  MappingConfig config = config_of(0.1, -1);
  config.max_scan_mb = 8;
  Mapper mapper(config, workers);
  const std::vector<Eigen::Vector3f> near{{1, 2, 3}};
  ASSERT_TRUE(mapper.insert(near, {0, 0, 0}));
  const std::string before = data_of(mapper.tree());
  const auto wide = mapper.insert(sphere(3000, 200), {0, 0, 0});
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.error().cause, "the scan touches too much space");
  const auto deep = mapper.insert(sphere(10000, 3000), {0, 0, 0});
  ASSERT_FALSE(deep);
  EXPECT_EQ(deep.error().code, Errc::kLimit);
  EXPECT_EQ(data_of(mapper.tree()), before);
  ASSERT_TRUE(mapper.insert(near, {0, 0, 0})) << "and goes on working";
  Mapper fresh(config_of(0.1, -1), workers);
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(fresh.insert(near, {0, 0, 0}));
  EXPECT_EQ(data_of(mapper.tree()), data_of(fresh.tree()));
}

TEST(Mapper, RefusesToGrowBeyondItsMemory) {
  Workers workers(1);
  MappingConfig config = config_of(0.1, 30);
  config.max_mb = 16;
  Mapper mapper(config, workers);
  const ScanYard yard(1800);
  Result<InsertReport> report;
  for (int i = 0; i < 40 && report; ++i) report = mapper.insert(yard.scan(8 * i).points, yard.scan(8 * i).origin);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().cause, "the map is as large as allowed");
  EXPECT_LT(mapper.tree().memoryUsage(), std::size_t{64} << 20U);
}

TEST(Mapper, DoesNotAllocateWhenWarm) {
  Workers workers(2);
  MappingConfig config = config_of(0.2, 20);
  config.reserve_mb = 32;
  Mapper mapper(config, workers);
  const ScanYard yard(support::rounds(900, 150));
  std::vector<MapScan> scans;
  for (int i = 0; i < 12; ++i) scans.push_back(yard.scan(i));
  for (const MapScan& scan : scans) ASSERT_TRUE(mapper.insert(scan.points, scan.origin));
  const std::size_t memory = mapper.tree().memoryUsage();
  const std::size_t before = support::allocation_count();
  for (const MapScan& scan : scans) ASSERT_TRUE(mapper.insert(scan.points, scan.origin));
  EXPECT_EQ(support::allocation_count() - before, 0U);
  EXPECT_EQ(mapper.tree().memoryUsage(), memory);
}

/// Unknown, free or occupied.
int state_of(const SemanticOcTree& tree, const octomap::OcTreeKey& key) {
  const SemanticNode* node = tree.search(key);
  return node == nullptr ? 0 : tree.isNodeOccupied(node) ? 2 : 1;
}

/// All voxels whose state differs between two trees, as tiles.
std::set<TileKey> tiles_that_differ(const SemanticOcTree& before, const SemanticOcTree& after) {
  std::set<TileKey> tiles;
  for (auto leaf = after.begin_leafs(); leaf != after.end_leafs(); ++leaf) {
    const unsigned edge = 1U << (16 - leaf.getDepth());
    const octomap::OcTreeKey first = leaf.getIndexKey();
    for (unsigned i = 0; i < edge * edge * edge; ++i) {
      const octomap::OcTreeKey key(static_cast<octomap::key_type>(first[0] + i % edge),
                                   static_cast<octomap::key_type>(first[1] + i / edge % edge),
                                   static_cast<octomap::key_type>(first[2] + i / edge / edge));
      if (state_of(before, key) != state_of(after, key)) tiles.insert(TileKey::of_voxel(key[0], key[1], key[2]));
    }
  }
  return tiles;
}

TEST(Mapper, ChangedTilesAreThoseWhereAVoxelChangedItsState) {
  Workers workers(2);
  Mapper mapper(config_of(0.25, 12), workers);
  const ScanYard yard(300);
  for (int i = 0; i < 8; ++i) {
    const SemanticOcTree before(mapper.tree());
    const MapScan scan = yard.scan(i / 2 * 20);  // every place twice: some tiles stay as they are
    const auto report = mapper.insert(scan.points, scan.origin);
    ASSERT_TRUE(report);
    const std::set<TileKey> expected = tiles_that_differ(before, mapper.tree());
    const std::vector<TileKey> taken = mapper.take_changed_tiles();
    EXPECT_EQ(taken, std::vector<TileKey>(expected.begin(), expected.end())) << "in canonical order";
    EXPECT_EQ(report->changed_tiles, taken.size());
    EXPECT_TRUE(mapper.changed_tiles().empty());
  }
}

TEST(Mapper, ChangedTilesAccumulateUntilTheyAreTaken) {
  Workers workers(1);
  Mapper one_by_one(config_of(0.25, 12), workers), at_once(config_of(0.25, 12), workers);
  const ScanYard yard(300);
  std::set<TileKey> expected;
  for (int i = 0; i < 5; ++i) {
    const MapScan scan = yard.scan(20 * i);
    ASSERT_TRUE(one_by_one.insert(scan.points, scan.origin));
    ASSERT_TRUE(at_once.insert(scan.points, scan.origin));
    for (const TileKey tile : one_by_one.take_changed_tiles()) expected.insert(tile);
  }
  EXPECT_EQ(at_once.take_changed_tiles(), std::vector<TileKey>(expected.begin(), expected.end()));
}

}  // namespace
}  // namespace cairn::mapping
