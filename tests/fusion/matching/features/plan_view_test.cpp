// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/plan_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace cairn::matching {
namespace {

constexpr float kFullRoom_m = 0.8F;  // plan_view.cpp's
constexpr float kMiss = -0.4F;       // log-odds of a voxel seen free

struct Place {
  mapping::SemanticOcTree map;
  std::vector<Eigen::Vector3f> free;  // centres of voxels
  std::vector<Surfel> surfels;
};

/// Free voxels at random, more of them in some columns than count, and few enough that no leaf of the tree is pruned.
Place random_place(double voxel_m, const SE3& T_plan_map) {
  Place place{.map = mapping::SemanticOcTree(voxel_m), .free = {}, .surfels = {}};
  std::mt19937 random(5);
  std::uniform_real_distribution<float> at(-6, 6), up(0, 3), chance(0, 1);
  const auto n = static_cast<int>(12 / voxel_m);
  for (int x = -n / 2; x < n / 2; ++x)
    for (int y = -n / 2; y < n / 2; ++y) {
      const float share = x / 8 % 2 == 0 ? 0.1F : 0.7F;  // in stripes, wider than a column
      for (int z = 0; z < n / 4; ++z) {
        if (chance(random) > share) continue;
        const Eigen::Vector3f centre =
            static_cast<float>(voxel_m) * (Eigen::Vector3f(float(x), float(y), float(z)).array() + 0.5F);
        place.map.updateNode(octomap::point3d(centre.x(), centre.y(), centre.z()), kMiss, true);
        place.free.push_back(centre);
      }
    }
  for (int i = 0; i < 40; ++i) {
    Surfel s;
    s.point = T_plan_map.rotation().cast<float>() * Eigen::Vector3f(at(random), at(random), up(random));
    s.normal = Eigen::Vector3f(at(random), at(random), 0).normalized();
    place.surfels.push_back(s);
  }
  return place;
}

/// The column of a grid at a place; `middle`: of the first column.
std::pair<int, int> column_of(const Eigen::Vector2f& at, const Eigen::Vector2f& middle) {
  const Eigen::Array2f columns = (at - middle).array() / PlanView::kColumn_m;
  return {static_cast<int>(std::floor(columns.x() + 0.5F)), static_cast<int>(std::floor(columns.y() + 0.5F))};
}

/// How many free voxels there are in each column of a grid; `middle`: of any of the columns.
std::map<std::pair<int, int>, int> counted(const Place& place, const Eigen::Matrix3f& R,
                                           const Eigen::Vector2f& middle) {
  std::map<std::pair<int, int>, int> counts;
  for (const Eigen::Vector3f& p : place.free) ++counts[column_of((R * p).head<2>(), middle)];
  return counts;
}

class PlanViewOf : public testing::TestWithParam<std::pair<double, double>> {};

// The plan leaves a column out once its room is full, and takes two voxels that stand on each other for one. Here every
// voxel is counted.
TEST_P(PlanViewOf, OpenColumnsHoldTheFreeSpaceThatWasSeen) {
  const auto [voxel_m, lean_rad] = GetParam();
  Vector6 v;
  v << 0, 0, 0, lean_rad, -0.5 * lean_rad, 0;
  const SE3 turn = SE3::from_xyz_rpy(v);
  const Place place = random_place(voxel_m, turn);
  const PlanView plan(place.surfels, place.map, turn);
  const Eigen::Matrix3f R = turn.rotation().cast<float>();
  const float voxel_m3 = static_cast<float>(voxel_m * voxel_m * voxel_m),
              full_m3 = kFullRoom_m * PlanView::kColumn_m * PlanView::kColumn_m;
  const float most_off = lean_rad == 0 ? 2 * voxel_m3 / full_m3 : 0.3F;
  const auto open_one = std::ranges::find(plan.columns(), 0.0F, &PlanView::Column::mass);
  ASSERT_NE(open_one, plan.columns().end());
  auto voxels = counted(place, R, open_one->at);
  int full = 0, some = 0;
  float off = 0;
  for (const PlanView::Column& c : plan.columns()) {
    if (c.mass > 0) continue;
    const float room_m3 = voxel_m3 * static_cast<float>(voxels[column_of(c.at, open_one->at)]);
    const float open = std::min(1.0F, room_m3 / full_m3);
    ASSERT_NEAR(c.open, open, most_off) << c.at.transpose();
    off += c.open - open;
    (c.open < 1 ? some : full) += 1;
  }
  EXPECT_GT(full, 100);
  EXPECT_GT(some, 100);
  EXPECT_NEAR(off / static_cast<float>(full + some), 0, 0.005F);
}

INSTANTIATE_TEST_SUITE_P(VoxelsAndLeans, PlanViewOf,
                         testing::Values(std::pair(0.1, 0.0), std::pair(0.1, 0.08), std::pair(0.2, 0.0),
                                         std::pair(0.2, 0.08)));

TEST(PlanView, AColumnWithAWallIsNotOpen) {
  const Place place = random_place(0.2, {});
  const PlanView plan(place.surfels, place.map);
  for (const Surfel& s : place.surfels)
    EXPECT_TRUE(std::ranges::any_of(plan.columns(), [&](const PlanView::Column& c) {
      return c.mass > 0 && c.open == 0 && (c.at - s.point.head<2>()).norm() < PlanView::kColumn_m * std::sqrt(2.0F);
    }));
}

}  // namespace
}  // namespace cairn::matching
