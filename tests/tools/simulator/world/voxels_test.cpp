// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/voxels.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "hal/semantic_class.hpp"
#include "onboard/mapping/files/class_colour.hpp"
#include "tools/simulator/world/random.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

World hall() {
  World world;
  world.mesh.box({0.03, 0.04, 0.01, 0.3}, 4, 3, 2, Material::kPlaster);
  world.mesh.box({0.6, 0.3, 0.01, 0.8}, 0.7, 0.5, 0.8, Material::kWood);
  world.mesh.cylinder({-1.0, 0.2, 0.01, 0}, 0.3, 0.2, 1.2, 12, Material::kConcrete);
  world.bounds = world.mesh.bounds();
  world.ground = [](double, double) { return 0.0; };
  return world;
}

TEST(Voxels, SurfacePointsAreOccupied) {
  const World world = hall();
  const Vector3d seeds[] = {{0.0, -0.8, 0.5}};
  const Voxels voxels(world, 0.1, seeds);
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Triangle& t = world.mesh.triangles()[random.below(world.mesh.triangles().size())];
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vector3d a = t.a.cast<double>();
    const Vector3d p = a + u * (t.b.cast<double>() - a) + v * (t.c.cast<double>() - a);
    ASSERT_EQ(voxels.at(p), Voxels::kOccupied) << p.transpose();
  }
}

TEST(Voxels, OccupiedVoxelsHaveASurface) {
  // Densely sampled surface points, grown by half of the sampling distance, cover every voxel that is really crossed.
  const World world = hall();
  const Voxels voxels(world, 0.1, {});
  std::vector<Vector3d> samples;
  for (const Triangle& t : world.mesh.triangles()) {
    const Vector3d a = t.a.cast<double>(), ab = t.b.cast<double>() - a, ac = t.c.cast<double>() - a;
    const int n = static_cast<int>(std::ceil(std::max({ab.norm(), ac.norm(), (ac - ab).norm()}) / 0.02));
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) samples.push_back(a + ab * i / n + ac * j / n);
    }
  }
  octomap::KeySet touched;
  const octomap::ColorOcTree grid(0.1);
  for (const Vector3d& s : samples) {
    for (int corner = 0; corner < 27; ++corner) {
      const Vector3d p = s + 0.02 * Vector3d(corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1);
      touched.insert(grid.coordToKey(p.x(), p.y(), p.z()));
    }
  }
  int occupied = 0;
  for (double x = -2.55; x < 2.6; x += 0.1) {
    for (double y = -2.55; y < 2.6; y += 0.1) {
      for (double z = -0.05; z < 2.1; z += 0.1) {
        if (voxels.at({x, y, z}) != Voxels::kOccupied) continue;
        ++occupied;
        ASSERT_EQ(touched.count(grid.coordToKey(x, y, z)), 1u) << x << ' ' << y << ' ' << z;
      }
    }
  }
  EXPECT_GT(occupied, 3000);
}

TEST(Voxels, FreeIsWhatIsConnectedWithTheSeeds) {
  const Vector3d seeds[] = {{0.0, -0.8, 0.5}};
  const Voxels voxels(hall(), 0.1, seeds);
  EXPECT_EQ(voxels.at({0.0, -0.8, 1.5}), Voxels::kFree);
  EXPECT_EQ(voxels.at({0.6, 0.3, 1.2}), Voxels::kFree);     // above the box
  EXPECT_EQ(voxels.at({0.6, 0.3, 0.4}), Voxels::kUnknown);  // inside of it
  EXPECT_EQ(voxels.at({2.4, 2.4, 1.0}), Voxels::kUnknown);  // outside of the hall
  EXPECT_EQ(voxels.at({50, 50, 50}), Voxels::kUnknown);
}

TEST(Voxels, OctreeSaysTheSameEverywhere) {
  const Vector3d seeds[] = {{0.0, -0.8, 0.5}};
  const Voxels voxels(hall(), 0.1, seeds);
  std::stringstream file;
  ASSERT_TRUE(voxels.to_octree()->write(file));
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(file));
  const auto* tree = dynamic_cast<const octomap::ColorOcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->getResolution(), 0.1);
  EXPECT_EQ(tree->size(), tree->calcNumNodes());
  for (double x = -2.95; x < 3; x += 0.1) {
    for (double y = -2.95; y < 3; y += 0.1) {
      for (double z = -0.45; z < 3; z += 0.1) {
        const octomap::ColorOcTreeNode* node = tree->search(x, y, z);
        const Voxels::State expected = voxels.at({x, y, z});
        const Voxels::State found = node == nullptr              ? Voxels::kUnknown
                                    : tree->isNodeOccupied(node) ? Voxels::kOccupied
                                                                 : Voxels::kFree;
        ASSERT_EQ(found, expected) << x << ' ' << y << ' ' << z;
        if (node == nullptr) continue;
        const auto label = mapping::class_of({node->getColor().r, node->getColor().g, node->getColor().b});
        ASSERT_EQ(label.value_or(kIgnoredClass), voxels.class_at({x, y, z})) << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(Voxels, TheLargestSurfaceGivesTheClass) {
  World world;
  world.mesh.box({0.5, 0.5, 0.0, 0}, 0.84, 0.84, 0.85, Material::kPlaster);  // wall
  world.mesh.quad({0.0, 0.0, 0.01}, {1.0, 0.0, 0.01}, {1.0, 1.0, 0.01}, {0.0, 1.0, 0.01}, Material::kAsphalt);
  world.mesh.quad({0.3, 0.3, 0.88}, {0.7, 0.3, 0.88}, {0.7, 0.7, 0.88}, {0.3, 0.7, 0.88}, Material::kWood);
  world.bounds = world.mesh.bounds();
  const Voxels voxels(world, 0.1, {});
  EXPECT_EQ(voxels.class_at({0.02, 0.02, 0.05}), *find_class("road"));  // 0.01 m² of road, 0.0044 m² of wall
  EXPECT_EQ(voxels.class_at({0.05, 0.55, 0.25}), *find_class("wall"));
  EXPECT_EQ(voxels.class_at({0.15, 0.55, 0.85}), *find_class("wall"));
  EXPECT_EQ(voxels.class_at({0.5, 0.5, 0.5}), kIgnoredClass);  // inside
  EXPECT_EQ(voxels.class_at({5, 5, 5}), kIgnoredClass);        // outside of all
}

// A coat of paint 2 cm before a column: both faces have the same area in each voxel that has both. Road goes on below.
TEST(Voxels, WhatIsCoveredDoesNotGiveTheClass) {
  World world;
  world.mesh.quad({-1, -1, 0.01}, {2, -1, 0.01}, {2, 2, 0.01}, {-1, 2, 0.01}, Material::kAsphalt);
  world.mesh.quad({-1, -1, 3}, {2, -1, 3}, {2, 2, 3}, {-1, 2, 3}, Material::kCeiling);
  world.mesh.box({0.53, 0.53, 0.01, 0}, 0.40, 0.60, 2.0, Material::kConcrete);
  world.mesh.box({0.53, 0.53, 0.01, 0}, 0.44, 0.64, 1.0, Material::kPaint);
  world.bounds = world.mesh.bounds();
  const auto tracer = Tracer::build(world.mesh);
  ASSERT_TRUE(tracer);
  const Vector3d seeds[] = {{-0.5, -0.5, 1}};
  const Voxels all(world, 0.1, seeds), seen(world, 0.1, seeds, &*tracer);
  const Vector3d low{0.35, 0.55, 0.55}, high{0.35, 0.55, 1.55}, foot{0.33, 0.55, 0.05};
  EXPECT_EQ(all.class_at(low), *find_class("building"));
  EXPECT_EQ(seen.class_at(low), *find_class("wall"));
  EXPECT_EQ(seen.class_at(high), *find_class("building"));
  EXPECT_EQ(seen.class_at(foot), *find_class("wall")) << "the road below it is covered, and seen by nobody from below";
}

TEST(Voxels, ASurfaceWithoutClassGivesNone) {
  World world;
  world.mesh.box({0.5, 0.5, 0.0, 0}, 0.9, 0.9, 0.85, Material::kWood);
  world.bounds = world.mesh.bounds();
  const Voxels voxels(world, 0.1, {});
  EXPECT_EQ(voxels.at({0.05, 0.55, 0.25}), Voxels::kOccupied);
  EXPECT_EQ(voxels.class_at({0.05, 0.55, 0.25}), kIgnoredClass);
}

TEST(Voxels, InnerNodesAreAsOctomapComputesThem) {
  const Vector3d seeds[] = {{0.0, -0.8, 0.5}};
  const auto tree = Voxels(hall(), 0.1, seeds).to_octree();
  std::ostringstream before, after;
  tree->write(before);
  tree->updateInnerOccupancy();
  tree->write(after);
  EXPECT_EQ(before.str(), after.str());
}

class VoxelsOfEveryScene : public ::testing::TestWithParam<std::string> {};

TEST_P(VoxelsOfEveryScene, TrueReturnsLieInOrNextToOccupiedVoxels) {
  const World world = *make_world(GetParam());
  const auto tracer = Tracer::build(world.mesh);
  ASSERT_TRUE(tracer);
  std::vector<Vector3d> seeds;
  for (const Eigen::Vector2d& p : world.places) seeds.emplace_back(p.x(), p.y(), world.ground(p.x(), p.y()) + 0.7);
  const Voxels voxels(world, 0.1, std::span(seeds).first(1));
  int returns = 0, in = 0, next = 0, seen_through = 0;
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    const Vector3d origin = seeds[random.below(seeds.size())];
    const double azimuth = random.uniform(-3.14159, 3.14159), elevation = random.uniform(-0.26, 0.26);
    const Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation));
    const auto hit = tracer->trace({origin, direction}, 0.01, 100.0);
    if (!hit) continue;
    ++returns;
    const Vector3d p = origin + hit->distance * direction;
    in += voxels.at(p) == Voxels::kOccupied ? 1 : 0;
    bool near = false;
    for (int k = 0; k < 27; ++k) {
      near = near || voxels.at(p + 0.1 * Vector3d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)) == Voxels::kOccupied;
    }
    next += near ? 1 : 0;
    for (double d = 0.05; d < hit->distance - 0.2; d += 0.05) {
      seen_through += voxels.at(origin + d * direction) == Voxels::kUnknown ? 1 : 0;
    }
  }
  EXPECT_GT(returns, 2500);
  EXPECT_EQ(next, returns);
  EXPECT_GE(in, returns - 3);             // rounding may put a point on the wrong side of a voxel's face
  EXPECT_LE(seen_through, returns / 10);  // what rays pass is free: the flood reached it
}

INSTANTIATE_TEST_SUITE_P(Scenes, VoxelsOfEveryScene, ::testing::ValuesIn(scene_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace cairn::simulator
