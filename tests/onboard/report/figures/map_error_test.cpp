// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/map_error.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "onboard/mapping/files/point_file.hpp"
#include "tests/onboard/report/random_map.hpp"
#include "tests/support/hostile_maps.hpp"

namespace cairn::report {
namespace {

TEST(DistanceToOccupied, AgreesWithALookAtEveryVoxel) {
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto map = random_map(seed);
    const auto centres = mapping::occupied_voxel_centres(*map).value();
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d p(place(engine), place(engine), place(engine));
      double nearest = std::numeric_limits<double>::max();
      for (const Eigen::Vector3f& c : centres) nearest = std::min(nearest, (c.cast<double>() - p).norm());
      const auto found = distance_to_occupied(*map, p, 10);
      ASSERT_TRUE(found.has_value());
      // Inside a pruned cube the distance is to the hull of its voxel centres, which may be a little nearer.
      EXPECT_LE(*found, nearest + 1e-6);
      EXPECT_GE(*found, nearest - 0.1 * std::sqrt(3.0) / 2 - 1e-6);
      EXPECT_EQ(distance_to_occupied(*map, p, 0.1).has_value(), *found <= 0.1);
    }
  }
}

TEST(DistanceToOccupied, OfAnEmptyMapIsNone) {
  EXPECT_FALSE(distance_to_occupied(mapping::SemanticOcTree(0.1), {0, 0, 0}, 100).has_value());
}

std::unique_ptr<mapping::SemanticOcTree> wall(float x) {
  auto map = std::make_unique<mapping::SemanticOcTree>(0.1);
  for (int y = 0; y < 20; ++y)
    for (int z = 0; z < 10; ++z)
      map->updateNode(octomap::point3d(x, 0.05F + 0.1F * static_cast<float>(y), 0.05F + 0.1F * static_cast<float>(z)),
                      true);
  return map;
}

TEST(MapError, OfTheTruthIsNone) {
  const auto map = random_map(1);
  const auto e = map_error(*map, *map, {});
  ASSERT_TRUE(e.has_value());
  EXPECT_NEAR(e->mean_m, 0, 1e-6);
  EXPECT_EQ(e->precision(), 1.0);
  EXPECT_EQ(e->recall(), 1.0);
  EXPECT_EQ(e->unseen + e->contradicted, 0U);
}

TEST(MapError, OfAWallMovedByThreeVoxelsIsThat) {
  const auto e = map_error(*wall(2.35F), *wall(2.05F), {});
  EXPECT_NEAR(e->mean_m, 0.3, 1e-5);
  EXPECT_NEAR(e->rmse_m, 0.3, 1e-5);
  EXPECT_EQ(e->occupied, 200U);
  EXPECT_EQ(e->precision(), 0.0);
  EXPECT_EQ(e->unseen, 200U);
  EXPECT_FALSE(e->recall().has_value());
  EXPECT_EQ(map_error(*wall(2.35F), *wall(2.05F), {{}, 0.31, 1})->precision(), 1.0);
}

TEST(MapError, MovesTheMapIntoTheTrueFrame) {
  const SE3 T_truth_map(Eigen::Quaterniond::Identity(), {-0.3, 0, 0});
  const auto e = map_error(*wall(2.35F), *wall(2.05F), {T_truth_map, 0, 1});
  EXPECT_NEAR(e->mean_m, 0, 1e-5);
  EXPECT_EQ(e->recall(), 1.0);
}

TEST(MapError, TellsWhatIsContradictedFromWhatWasNeverSeen) {
  const auto truth = wall(2.05F);
  mapping::SemanticOcTree map(0.1);
  for (int z = 0; z < 10; ++z)
    map.updateNode(octomap::point3d(2.05F, 1.55F, 0.05F + 0.1F * static_cast<float>(z)), false);
  const auto e = map_error(map, *truth, {});
  EXPECT_EQ(e->contradicted, 10U);
  EXPECT_EQ(e->unseen, 190U);
  EXPECT_EQ(e->recall(), 0.0);
  EXPECT_FALSE(e->precision().has_value());
}

TEST(MapError, OfMapsThatNoMemoryHoldsIsRefused) {
  for (const auto& [name, map] : support::hostile_maps()) {
    const auto e = map_error(*map, *wall(2.05F), {});
    EXPECT_EQ(e.has_value(), mapping::listable_voxels(*map).has_value()) << name;
    EXPECT_TRUE(e || e.error().code == Errc::kLimit) << name;
  }
}

TEST(MapError, FarOutliersCountAsTheLimit) {
  const auto e = map_error(*wall(9.05F), *wall(2.05F), {{}, 0, 1.5});
  EXPECT_NEAR(e->mean_m, 1.5, 1e-9);
}

}  // namespace
}  // namespace cairn::report
