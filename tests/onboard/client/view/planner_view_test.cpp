// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/view/planner_view.hpp"

#include <gmock/gmock.h>

#include "tests/onboard/client/view/painted_map.hpp"

namespace cairn::client {
namespace {

using test::PaintedMap;

const Eigen::Vector3d kHere(0.55, 0.55, 0.55), kThere(3.55, 0.55, 0.55);

/// This robot saw the left place free and knows nothing of the right one; a peer says that both are occupied.
class PlannerViewTest : public ::testing::Test {
 protected:
  PlannerViewTest() {
    own_.box({0, 0, 0}, {1, 1, 1}, false);
    team_.box({0, 0, 0}, {4, 1, 1}, true);
  }
  PaintedMap own_, team_{clients::TileMap::kTeam};
};

TEST_F(PlannerViewTest, WhatTheRobotSawItselfIsNeverOverruled) {
  const PlannerView view(own_.mirror(), &team_.mirror(7), SE3());
  EXPECT_EQ(view.at(kHere).occupancy, Occupancy::kFree);
  EXPECT_TRUE(view.at(kHere).own);
  EXPECT_EQ(view.occupancy(kHere), Occupancy::kFree);
}

TEST_F(PlannerViewTest, TheTeamFillsWhatItHasNotSeen) {
  const Time when{std::chrono::seconds(9)};
  const PlannerView view(own_.mirror(), &team_.mirror(7, when), SE3());
  const Place place = view.at(kThere);
  EXPECT_EQ(place.occupancy, Occupancy::kOccupied);
  EXPECT_FALSE(place.own);
  EXPECT_THAT(place.robots, ::testing::ElementsAre(7U));
  EXPECT_EQ(place.changed, when);
}

TEST_F(PlannerViewTest, TheTeamsMapLiesWhereItsPoseSays) {
  const SE3 T_team_odom(Eigen::Quaterniond::Identity(), Eigen::Vector3d(3, 0, 0));
  const PlannerView view(own_.mirror(), &team_.mirror(), T_team_odom);
  EXPECT_EQ(view.occupancy({-2.45, 0.55, 0.55}), Occupancy::kOccupied);
  EXPECT_EQ(view.occupancy(kThere), Occupancy::kUnknown);
}

TEST_F(PlannerViewTest, WithoutItsPoseTheTeamsMapSaysNothing) {
  const PlannerView view(own_.mirror(), &team_.mirror(), std::nullopt);
  EXPECT_EQ(view.at(kThere).occupancy, Occupancy::kUnknown);
  EXPECT_EQ(PlannerView(own_.mirror(), nullptr, SE3()).occupancy(kThere), Occupancy::kUnknown);
}

TEST_F(PlannerViewTest, PlacesThatNoMapCanHoldAreUnknown) {
  const PlannerView view(own_.mirror(), &team_.mirror(), SE3());
  for (const double x : {1e9, -1e9, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(view.at({x, 0, 0}).occupancy, Occupancy::kUnknown);
  EXPECT_FALSE(view.first_hit({0, 0, 0}, {1e12, 0, 0}));
}

TEST_F(PlannerViewTest, ARayEndsAtTheFirstOccupiedPlace) {
  const PlannerView view(own_.mirror(), &team_.mirror(), SE3());
  const auto hit = view.first_hit(kHere, kThere);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->x(), 1.0, 0.06) << "where the own free space ends";
  EXPECT_FALSE(view.first_hit(kHere, kHere));
}

}  // namespace
}  // namespace cairn::client
