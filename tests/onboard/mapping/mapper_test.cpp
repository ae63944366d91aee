// SPDX-License-Identifier: Apache-2.0
// The oracle is octomap::OcTree::insertPointCloud(): after every scan the trees must be equal node by node, bit by bit.
#include "onboard/mapping/mapper.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <set>

#include "tests/onboard/mapping/scan_yard.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn {
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
  MappingConfig config;
  config.resolution_m = s.resolution;
  config.max_range_m = s.max_range;
  Mapper mapper(config, workers);
  octomap::OcTree stock(s.resolution);
  const ScanYard yard(s.azimuths);
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
                         testing::Values(Setting{"coarse", 0.2, 30, 1, 1800, 6}, Setting{"fine", 0.1, 15, 1, 300, 6},
                                         Setting{"unlimited", 0.25, -1, 1, 600, 6},
                                         Setting{"two_threads", 0.2, 30, 2, 600, 6},
                                         Setting{"short_range", 0.5, 5, 3, 600, 10}),
                         [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace cairn
