// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/scenes/make_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "tools/simulator/motion/drive.hpp"
#include "tools/simulator/motion/path.hpp"
#include "tools/simulator/motion/route.hpp"
#include "tools/simulator/world/floor_plan.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {
namespace {

class WorldOfEveryScene : public ::testing::TestWithParam<std::string> {
 protected:
  World world_ = *make_world(GetParam());
};

/// Free length along ±`direction` from `at`, past furniture: the farthest surface, not the nearest.
double extent(const Tracer& tracer, Eigen::Vector3d at, const Eigen::Vector3d& direction) {
  double length = 0;
  for (int i = 0; i < 200; ++i) {
    const auto hit = tracer.trace({at, direction}, 1e-3, 200.0);
    if (!hit) break;
    length += hit->distance;
    at += hit->distance * direction;
  }
  return length;
}

TEST_P(WorldOfEveryScene, IsTheSameEveryTime) {
  const World again = *make_world(GetParam());
  ASSERT_EQ(again.mesh.triangles().size(), world_.mesh.triangles().size());
  for (std::size_t i = 0; i < again.mesh.triangles().size(); ++i) {
    const Triangle &a = again.mesh.triangles()[i], &b = world_.mesh.triangles()[i];
    ASSERT_TRUE(a.a == b.a && a.b == b.b && a.c == b.c && a.material == b.material);
  }
}

TEST_P(WorldOfEveryScene, HasFiniteTrianglesWithAnArea) {
  for (const Triangle& t : world_.mesh.triangles()) {
    const float twice_area = (t.b - t.a).cross(t.c - t.a).norm();
    ASSERT_TRUE(std::isfinite(twice_area));
    ASSERT_GT(twice_area, 1e-7F) << t.a.transpose();
  }
}

TEST_P(WorldOfEveryScene, MostPlacesCanBeReachedFromEachOther) {
  const FloorPlan plan(world_);
  const RoutePlanner planner(world_, plan, 1);
  EXPECT_GE(planner.places().size(), 8u);
  EXPECT_GE(static_cast<double>(planner.places().size()), 0.8 * static_cast<double>(world_.places.size()));
}

TEST_P(WorldOfEveryScene, TheMeshLiesUnderTheWheels) {
  const auto tracer = Tracer::build(world_.mesh);
  ASSERT_TRUE(tracer);
  for (const Eigen::Vector2d& p : world_.places) {
    const double ground = world_.ground(p.x(), p.y());
    const auto hit = tracer->trace({{p.x(), p.y(), ground + 0.5}, -Eigen::Vector3d::UnitZ()}, 1e-3, 10.0);
    ASSERT_TRUE(hit) << p.transpose();
    EXPECT_NEAR(hit->distance, 0.5, 0.03) << p.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, WorldOfEveryScene, ::testing::ValuesIn(scene_names()),
                         [](const auto& test) { return test.param; });

TEST(World, ScenesHaveThePromisedSizes) {
  const std::pair<const char*, Eigen::Vector3d> promised[] = {{"corridor", {20, 5, 3}},
                                                              {"hallway", {20, 5, 3}},
                                                              {"lobby", {40, 15, 3}},
                                                              {"office", {50, 40, 3}},
                                                              {"carpark", {48, 32, 2.8}}};
  for (const auto& [name, size] : promised) {
    const World world = *make_world(name);
    EXPECT_EQ(world.inner_size, size) << name;
    const auto tracer = Tracer::build(world.mesh);
    ASSERT_TRUE(tracer);
    // Walls may stand outside of the clear size, never inside of it.
    EXPECT_GE(world.bounds.sizes().x(), size.x() - 1e-3) << name;
    EXPECT_LE(world.bounds.sizes().x(), size.x() + 0.7) << name;
    EXPECT_GE(world.bounds.sizes().y(), size.y() - 1e-3) << name;
    const Eigen::Vector2d p = world.places.front();
    const Eigen::Vector3d at(p.x(), p.y(), 1.3);
    EXPECT_NEAR(world.bounds.sizes().z(), size.z(), 1e-3) << name;
    EXPECT_GE(extent(*tracer, at, Eigen::Vector3d::UnitX()) + extent(*tracer, at, -Eigen::Vector3d::UnitX()),
              size.x() - 1e-3)
        << name;
  }
}

TEST(World, CorridorTellsNothingAboutItsLongAxis) {
  // Every surface that returns anything runs along x.
  const World world = *make_world("corridor");
  for (const Triangle& t : world.mesh.triangles()) {
    const Eigen::Vector3f normal = (t.b - t.a).cross(t.c - t.a).normalized();
    if (properties(t.material).reflectivity > 0) {
      EXPECT_LT(std::abs(normal.x()), 1e-6F);
    }
  }
}

TEST(World, OfficeHasManyAlikeRooms) {
  // Each open room adds one place to the 27 of the corridors.
  EXPECT_GE(make_world("office")->places.size() - 27, 40u);
}

TEST(World, StreetHasMostOfCityscapesClasses) {
  std::set<int> classes;
  const World world = *make_world("street");
  for (const Triangle& t : world.mesh.triangles()) classes.insert(properties(t.material).class_id);
  classes.erase(kIgnoredClass);
  EXPECT_GE(classes.size(), 14u);
  for (const int promised : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 14, 15, 17, 18})
    EXPECT_EQ(classes.count(promised), 1u) << promised;
}

TEST(World, StreetAndTramStopHaveAllClassesOfThingsThatStand) {
  std::set<int> classes;
  for (const char* name : {"street", "tramstop"}) {
    const World world = *make_world(name);
    for (const Triangle& t : world.mesh.triangles()) classes.insert(properties(t.material).class_id);
  }
  for (int k = 0; k < 19; ++k) {
    const bool elsewhere = k == kSkyClass || k == kPersonClass;  // the sky is no surface, and people walk
    EXPECT_EQ(classes.count(k), elsewhere ? 0U : 1U) << k;
  }
}

TEST(World, ForestHasASlope) {
  const World world = *make_world("forest");
  EXPECT_GT(world.ground(55, 55) - world.ground(5, 5), 3.0);
  double steepest = 0;
  for (double x = 2; x < 58; x += 0.5) {
    for (double y = 2; y < 58; y += 0.5) {
      const Eigen::Vector2d rise(world.ground(x + 0.1, y) - world.ground(x, y),
                                 world.ground(x, y + 0.1) - world.ground(x, y));
      steepest = std::max(steepest, rise.norm() / 0.1);
    }
  }
  EXPECT_LT(steepest, 0.45);
}

TEST(World, UnknownSceneNamesTheKnownOnes) {
  const auto world = make_world("moon");
  ASSERT_FALSE(world);
  EXPECT_EQ(world.error().code, Errc::kNotFound);
  for (const std::string& name : scene_names()) EXPECT_NE(world.error().detail.find(name), std::string::npos);
}

}  // namespace
}  // namespace cairn::simulator
