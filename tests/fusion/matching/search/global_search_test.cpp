// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/global_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/features/levelling.hpp"
#include "fusion/matching/features/sample.hpp"
#include "fusion/matching/matcher.hpp"
#include "fusion/matching/search/stand_up.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

class OfOffice : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    pair = new support::MapPair(support::two_robots(support::office(), {0, 2.2, 14}, {1.0, 3.2, 14}, 3, -2.4));
    a = new SurfaceModel(surface_model_of(*MapFeatures::build(*pair->a)));
    b = new SurfaceModel(surface_model_of(*MapFeatures::build(*pair->b)));
  }
  static void TearDownTestSuite() {
    delete b;
    delete a;
    delete pair;
  }
  /// Off from the truth at the middle of b's walls, m.
  static double off(const SE3& T, const PlanView& of_b) {
    const Eigen::Vector3d middle(of_b.middle().cast<double>().x(), of_b.middle().cast<double>().y(), 0);
    return (T * middle - pair->T_a_b * middle).norm();
  }
  static support::MapPair* pair;
  static SurfaceModel *a, *b;
};
support::MapPair* OfOffice::pair = nullptr;
SurfaceModel* OfOffice::a = nullptr;
SurfaceModel* OfOffice::b = nullptr;

TEST_F(OfOffice, TheTruthIsAmongTheFirstPlacements) {
  const PlanView of_a(a->surfels, *pair->a), of_b(b->surfels, *pair->b);
  Budget budget = Budget::steps(kAmpleSteps);
  const GlobalSearchConfig config;
  const auto placements = sweep(of_a, of_b, config, budget);
  ASSERT_GT(placements.size(), 20U);
  EXPECT_LE(placements.size(), config.placements);
  const auto voters = sample(std::span<const Surfel>(b->surfels), config.height_votes);
  const auto poses = stand_up(std::span(placements).first(20), of_a, of_b, voters);
  double least = 1e9;
  for (const SE3& T : poses)
    if (rotation_angle(T.inverse() * pair->T_a_b) < 0.08) least = std::min(least, off(T, of_b));
  EXPECT_LT(least, 0.8);
}

TEST_F(OfOffice, APlacementIsFoundAtAnyHeight) {
  const PlanView of_a(a->surfels, *pair->a), of_b(b->surfels, *pair->b);
  const Eigen::Vector3d middle = pair->T_a_b * Eigen::Vector3d(of_b.middle().x(), of_b.middle().y(), 0);
  const double yaw = std::atan2(pair->T_a_b.rotation()(1, 0), pair->T_a_b.rotation()(0, 0));
  const Placement truth{.yaw_rad = yaw, .x_m = middle.x(), .y_m = middle.y()};
  for (const float up_m : {-150.0F, -17.0F, 0.0F, 40.0F}) {
    std::vector<Surfel> raised(b->surfels);
    for (Surfel& s : raised) s.point.z() += up_m;
    const auto voters = sample(std::span<const Surfel>(raised), 600);
    const auto poses = stand_up({&truth, 1}, of_a, of_b, voters);
    ASSERT_FALSE(poses.empty());
    EXPECT_NEAR(poses.front().translation().z(), pair->T_a_b.translation().z() - static_cast<double>(up_m), 0.15);
  }
}

// The opposite of a heading is made of the same drawing, backwards.
TEST_F(OfOffice, APlanTurnedByHalfACircleIsFoundAtTheSamePlaces) {
  const SE3 half_turn(Eigen::Vector3d(-1, -1, 1).asDiagonal(), Eigen::Vector3d::Zero());
  const auto turned_b = turned(b->surfels, half_turn);
  const PlanView of_a(a->surfels, *pair->a), of_b(b->surfels, *pair->b), of_turned(turned_b, *pair->b, half_turn);
  Budget budget = Budget::steps(kAmpleSteps);
  GlobalSearchConfig config;
  config.room_weights.fill(3);  // so that walls in the other map's room decide
  const auto placements = sweep(of_a, of_b, config, budget), others = sweep(of_a, of_turned, config, budget);
  constexpr std::size_t kFirst = 3;  // whose columns fall differently, but who are far ahead of the rest
  ASSERT_GT(std::min(placements.size(), others.size()), 20U);
  const auto first_others = std::span(others).first(20);
  for (std::size_t i = 0; i < kFirst; ++i) {
    const Placement& p = placements[i];
    const auto same = [&](const Placement& q) {
      return std::hypot(p.x_m - q.x_m, p.y_m - q.y_m) < 0.8 && std::cos(p.yaw_rad - q.yaw_rad) < -0.99;
    };
    EXPECT_TRUE(std::ranges::any_of(first_others, same)) << i << ": " << p.x_m << " " << p.y_m << " " << p.yaw_rad;
  }
}

TEST_F(OfOffice, EveryHeadingIsAStep) {
  const PlanView of_a(a->surfels, *pair->a), of_b(b->surfels, *pair->b);
  for (const int steps : {1, 5}) {
    Budget budget = Budget::steps(steps);
    const auto placements = sweep(of_a, of_b, {}, budget);
    EXPECT_LE(budget.spent(), steps);
    EXPECT_FALSE(placements.empty());
  }
}

TEST_F(OfOffice, APlanKnowsWallsRoomAndHeights) {
  const PlanView plan(a->surfels, *pair->a);
  float walls = 0, room = 0, facing = 0;
  for (const PlanView::Column& c : plan.columns()) {
    walls += c.mass;
    room += c.open;
    facing += c.facing.norm();
    EXPECT_LE(c.facing.norm(), c.mass * 1.001F);
    EXPECT_LE(c.open, 1);
  }
  EXPECT_GT(walls, 50);
  EXPECT_GT(room, walls);
  EXPECT_GT(facing, 0.3F * walls);  // most walls were seen from one side
  EXPECT_FALSE(plan.heights(a->structure.front().point.head<2>()).empty());
  EXPECT_TRUE(plan.heights({1e30F, 0}).empty());
  EXPECT_TRUE(plan.heights({std::numeric_limits<float>::quiet_NaN(), 0}).empty());
}

TEST(PlanView, OfNothingIsEmptyAndOfFarThingsBounded) {
  const mapping::SemanticOcTree empty(0.1);
  const PlanView none({}, empty);
  EXPECT_TRUE(none.columns().empty());
  std::vector<Surfel> far(2);
  far[1].point = {6000, -6000, 0};
  const PlanView wide(far, empty);
  EXPECT_EQ(wide.columns().size(), 2U);
  Budget budget = Budget::steps(3);
  GlobalSearchConfig config;
  config.placements = 10;
  EXPECT_LE(sweep(wide, none, config, budget).size(), 10U);
}

}  // namespace
}  // namespace cairn::matching
