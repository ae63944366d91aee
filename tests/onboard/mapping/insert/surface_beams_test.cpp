// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/surface_beams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "onboard/mapping/mapper.hpp"
#include "tests/onboard/mapping/scan_yard.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::mapping {
namespace {

MappingConfig sparing_config(bool spare) { return {.resolution_m = 0.1, .spare_surfaces = spare}; }

/// What the downward beams of a VLP-16 meet of a floor at `height`, from `origin`, up to 25 m, ahead.
MapScan floor_scan(double height, double x, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.02);
  const Eigen::Vector3d origin(x, 0, 0.7);
  MapScan scan{{}, origin.cast<float>()};
  for (int ring = 1; ring <= 15; ring += 2)
    for (int a = -100; a <= 100; ++a) {
      const double down = ring * std::numbers::pi / 180, azimuth = a * 0.2 * std::numbers::pi / 180;
      const double range = (0.7 - height) / std::sin(down) + noise(random);
      const Eigen::Vector3d way(std::cos(down) * std::cos(azimuth), std::cos(down) * std::sin(azimuth),
                                -std::sin(down));
      if (range < 25) scan.points.emplace_back((origin + range * way).cast<float>());
    }
  return scan;
}

/// The share of the floor's columns with three hits or more that the map still has, after 10 m of driving towards it.
double floor_kept(double height, bool spare) {
  Workers workers(1);
  Mapper mapper(sparing_config(spare), workers);
  std::map<std::pair<int, int>, int> hits;
  for (unsigned i = 0; i < 100; ++i) {
    const MapScan scan = floor_scan(height, 0.1 * i, i);
    EXPECT_TRUE(mapper.insert(scan.points, scan.origin));
    for (const Eigen::Vector3f& p : scan.points)
      ++hits[{static_cast<int>(std::floor(p.x() * 10)), static_cast<int>(std::floor(p.y() * 10))}];
  }
  int seen = 0, kept = 0;
  for (const auto& [column, count] : hits) {
    if (count < 3) continue;
    ++seen;
    bool there = false;
    for (const double off : {-0.06, 0.01, 0.06}) {
      const Standing standing =
          mapper.standing({static_cast<float>(column.first) / 10 + 0.05F,
                           static_cast<float>(column.second) / 10 + 0.05F, static_cast<float>(height + off)});
      there = there || standing == Standing::kOccupied || standing == Standing::kSettled;
    }
    kept += there ? 1 : 0;
  }
  return static_cast<double>(kept) / seen;
}

TEST(SurfaceBeams, AFloorAheadStaysInTheMap) {
  for (const double height : {0.05, 0.0, 0.08}) {  // in the middle of its voxels, between two layers, near the border
    const double octomaps = 1 - floor_kept(height, false), lost = 1 - floor_kept(height, true);
    EXPECT_GT(octomaps, 0.15) << height;
    EXPECT_LT(lost, octomaps / 4) << height;
    EXPECT_LT(lost, 0.1) << height;
  }
}

/// A wall 5 m ahead, met straight on.
std::vector<Eigen::Vector3f> straight_wall() {
  std::vector<Eigen::Vector3f> points;
  for (int y = -5; y <= 5; ++y)
    for (int z = -5; z <= 5; ++z)
      points.emplace_back(5.05F, 0.1F * static_cast<float>(y) + 0.05F, 0.1F * static_cast<float>(z) + 0.05F);
  return points;
}

TEST(SurfaceBeams, WhatStoodBeforeAWallClearsAsEver) {
  for (const float gap : {0.1F, 0.4F, 1.0F, 3.0F}) {  // noise before the wall is one voxel thick
    Workers workers(1);
    Mapper sparing(sparing_config(true), workers), octomaps(sparing_config(false), workers);
    std::vector<Eigen::Vector3f> body = straight_wall();
    for (Eigen::Vector3f& p : body) p = {p.x() - gap, p.y() * 0.9F, p.z() * 0.9F};
    for (Mapper* mapper : {&sparing, &octomaps}) {
      for (int i = 0; i < 10; ++i) ASSERT_TRUE(mapper->insert(straight_wall(), {0.05F, 0.05F, 0.05F}));
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(mapper->insert(body, {0.05F, 0.05F, 0.05F}));
      for (int i = 0; i < 12; ++i) ASSERT_TRUE(mapper->insert(straight_wall(), {0.05F, 0.05F, 0.05F}));
      EXPECT_EQ(mapper->standing({5.05F - gap, 0.05F, 0.05F}), Standing::kFree);
    }
    EXPECT_EQ(data_of(sparing.tree()), data_of(octomaps.tree())) << gap;
  }
}

using Voxels = std::set<std::tuple<std::uint64_t, unsigned>>;

Voxels freed(const MapScan& scan, const SemanticOcTree* surfaces) {
  ScanRays rays(0.2, 30);
  Footprint footprint(1U << 16U);
  EXPECT_TRUE(rays.prepare(scan.points, scan.origin, footprint));
  rays.march(0, rays.ray_count(), march_rays_scalar, footprint, surfaces);
  Voxels voxels;
  for (const BrickRef& brick : footprint.sorted_bricks())
    for (unsigned i = 0; i < 4096; ++i)
      if ((footprint.free(brick.slot)[i / 64] >> (i % 64) & 1) != 0) voxels.insert({brick.path, i});
  return voxels;
}

TEST(SurfaceBeams, FreesNothingElse) {
  Workers workers(1);
  Mapper mapper({.resolution_m = 0.2, .spare_surfaces = true}, workers);
  const ScanYard yard(120);
  for (int i = 0; i < 5; ++i) {
    const MapScan scan = yard.scan(4 * i);
    const Voxels octomaps = freed(scan, nullptr), ours = freed(scan, &mapper.tree());
    EXPECT_TRUE(std::ranges::includes(octomaps, ours)) << i;
    EXPECT_EQ(ours.size() < octomaps.size(), i > 0) << i;  // an empty map has no surfaces
    EXPECT_GT(ours.size(), octomaps.size() * 9 / 10) << i;
    ASSERT_TRUE(mapper.insert(scan.points, scan.origin));
  }
}

}  // namespace
}  // namespace cairn::mapping
