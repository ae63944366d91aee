// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include "onboard/mapping/mapper.hpp"
#include "tests/onboard/mapping/scan_yard.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/rounds.hpp"

namespace cairn::mapping {
namespace {

/// OctoMap with another sensor model and range for every second scan.
TEST(MapperSensors, AnotherSensorHasItsOwnModelAndRange) {
  Workers workers(1);
  Mapper mapper({.resolution_m = 0.2, .spare_surfaces = false}, workers);
  const SensorTrust depth{.prob_hit = 0.6, .prob_miss = 0.45, .max_range_m = 4};
  octomap::OcTree stock(0.2);
  const ScanYard yard(support::rounds(300, 60));
  for (int i = 0; i < 6; ++i) {
    const MapScan scan = yard.scan(3 * i);
    const bool other = i % 2 == 1;
    stock.setProbHit(other ? depth.prob_hit : 0.7);
    stock.setProbMiss(other ? depth.prob_miss : 0.4);
    ASSERT_TRUE(other ? mapper.insert(scan.points, scan.origin, depth) : mapper.insert(scan.points, scan.origin));
    octomap::Pointcloud cloud;
    for (const Eigen::Vector3f& p : scan.points) cloud.push_back(p.x(), p.y(), p.z());
    stock.insertPointCloud(cloud, {scan.origin.x(), scan.origin.y(), scan.origin.z()}, other ? depth.max_range_m : 30,
                           false, true);
    ASSERT_EQ(differing_nodes(mapper.tree(), stock), 0U) << "scan " << i;
  }
}

/// Noise along the beam makes a wall thick. Sparing it would keep it so.
TEST(MapperSensors, AnotherSensorSparesNoSurfaces) {
  Workers workers(1);
  Mapper sparing({.resolution_m = 0.2, .spare_surfaces = true}, workers);
  Mapper octomaps({.resolution_m = 0.2, .spare_surfaces = false}, workers);
  const ScanYard yard(support::rounds(300, 60));
  for (int i = 0; i < 6; ++i)
    for (Mapper* mapper : {&sparing, &octomaps})
      ASSERT_TRUE(mapper->insert(yard.scan(3 * i).points, yard.scan(3 * i).origin, SensorTrust{}));
  EXPECT_EQ(data_of(sparing.tree()), data_of(octomaps.tree()));
}

}  // namespace
}  // namespace cairn::mapping
