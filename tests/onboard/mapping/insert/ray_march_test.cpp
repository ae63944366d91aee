// SPDX-License-Identifier: Apache-2.0
// The oracle is OctoMap's computeRayKeys(): the same voxels for every single ray.
#include "onboard/mapping/insert/ray_march.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "onboard/mapping/insert/scan_rays.hpp"

namespace cairn::mapping {
namespace {

using Key = std::tuple<int, int, int>;

/// The free voxels of one scan, by OctoMap.
std::set<Key> free_by_octomap(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& origin, double r) {
  const octomap::OcTree tree(r);
  octomap::KeyRay ray;
  std::set<Key> keys;
  for (const Eigen::Vector3f& p : points) {
    const octomap::point3d centre = tree.keyToCoord(tree.coordToKey(octomap::point3d(p.x(), p.y(), p.z())));
    tree.computeRayKeys({origin.x(), origin.y(), origin.z()}, centre, ray);
    for (const octomap::OcTreeKey& k : ray) keys.insert({k[0], k[1], k[2]});
  }
  return keys;
}

/// The same from a footprint.
std::set<Key> free_in(Footprint& footprint) {
  std::set<Key> keys;
  for (const BrickRef& brick : footprint.sorted_bricks())
    for (unsigned voxel = 0; voxel < 4096; ++voxel) {
      if ((footprint.free(brick.slot)[voxel / 64] >> (voxel % 64) & 1) == 0) continue;
      int key[3] = {0, 0, 0};
      const std::uint64_t path = brick.path << 12 | voxel;
      for (unsigned bit = 0; bit < 16; ++bit)
        for (unsigned a = 0; a < 3; ++a) key[a] |= static_cast<int>(path >> (3 * bit + a) & 1) << bit;
      keys.insert({key[0], key[1], key[2]});
    }
  return keys;
}

struct March {
  const char* name;
  MarchRays march;
};

class RayMarch : public testing::TestWithParam<March> {};

TEST_P(RayMarch, VisitsOctoMapsVoxels) {
  if (GetParam().march == nullptr) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(7);
  Footprint footprint(4096);
  for (int round = 0; round < 200; ++round) {
    const double r = round % 2 == 0 ? 0.25 : 0.1;
    const bool lattice = round % 4 < 2;
    const auto coordinate = [&](double spread) {
      const double x = std::uniform_real_distribution<double>(-spread, spread)(random);
      return static_cast<float>(lattice ? std::round(x / r) * r + (random() % 2 == 0 ? 0.5 * r : 0) : x);
    };
    const Eigen::Vector3f origin(coordinate(9), coordinate(9), coordinate(9));
    std::vector<Eigen::Vector3f> points;
    for (std::size_t n = 1 + random() % 11; n > 0; --n) {
      points.emplace_back(coordinate(5), coordinate(5), coordinate(5));
      if (random() % 5 == 0) points.back().x() = origin.x();
    }
    ScanRays rays(r, -1);
    ASSERT_TRUE(rays.prepare(points, origin, footprint));
    rays.march(0, rays.ray_count(), GetParam().march, footprint, nullptr);
    EXPECT_EQ(free_in(footprint), free_by_octomap(points, origin, r)) << "round " << round;
  }
}

INSTANTIATE_TEST_SUITE_P(Versions, RayMarch,
                         testing::Values(March{"scalar", march_rays_scalar}, March{"avx2", march_rays_avx2()}),
                         [](const auto& i) { return std::string(i.param.name); });

/// Borders at equal distances: OctoMap takes z before y before x, and so visits these voxels and no others.
TEST(RayMarchTies, GoAlongZThenYThenX) {
  Footprint footprint(64);
  footprint.reset(BrickGrid({0, 0, 0}, {63, 63, 63}));
  const BrickGrid& grid = footprint.grid();
  const Ray ray{{0.5, 0.5, 0.5},
                {1, 1, 1},
                100.0,
                grid.index({12, 12, 12}),
                {grid.axis_step(0, 1), grid.axis_step(1, 1), grid.axis_step(2, 1)}};
  march_rays_scalar({&ray, 1}, grid.index({10, 10, 10}), footprint);
  const std::set<Key> expected{{10, 10, 11}, {10, 11, 11}, {11, 11, 11}, {11, 11, 12}, {11, 12, 12}};
  EXPECT_EQ(free_in(footprint), expected);
}

/// A ray that rounding leads past its end voxel ends with its length.
TEST(RayMarchEnds, WithTheLengthWhenTheEndIsMissed) {
  for (const MarchRays march : {MarchRays{march_rays_scalar}, march_rays_avx2()}) {
    if (march == nullptr) continue;
    Footprint footprint(64);
    footprint.reset(BrickGrid({0, 0, 0}, {63, 63, 63}));
    const BrickGrid& grid = footprint.grid();
    const Ray ray{{0.5, 99, 99}, {1, 99, 99}, 4.2, grid.index({15, 11, 10}), {grid.axis_step(0, 1), 0, 0}};
    march({&ray, 1}, grid.index({10, 10, 10}), footprint);
    footprint.mark_free<true>(grid.index({10, 10, 10}));
    EXPECT_EQ(free_in(footprint), (std::set<Key>{{10, 10, 10}, {11, 10, 10}, {12, 10, 10}, {13, 10, 10}}));
  }
}

}  // namespace
}  // namespace cairn::mapping
