// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/published_edge.hpp"

#include <gtest/gtest.h>

namespace cairn::team {
namespace {

peers::Edge edge_at(double x, double yaw = 0, std::uint16_t own_submap = 0) {
  peers::Edge edge{.own_submap = own_submap, .other = 2, .other_epoch = 7, .T_own_other = {}, .probability = 0.97F};
  edge.T_own_other.mean = SE3::from_xyz_rpy((Vector6() << x, 0, 0, 0, 0, yaw).finished());
  return edge;
}

TEST(PublishedEdge, IsPublishedOnceUntilItMoves) {
  PublishedEdge edge(5);
  EXPECT_FALSE(edge.stands());
  const auto first = edge.update(edge_at(1));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->index, 5);
  EXPECT_EQ(first->edge.probability, 0.97F);
  EXPECT_TRUE(edge.stands());
  EXPECT_FALSE(edge.update(edge_at(1)));
  EXPECT_FALSE(edge.update(edge_at(1.015, 0.002)));
  EXPECT_TRUE(edge.update(edge_at(1.03)));
  EXPECT_TRUE(edge.update(edge_at(1.03, 0.004)));
}

TEST(PublishedEdge, SmallStepsAddUp) {
  PublishedEdge edge(0);
  int published = 0;
  for (int i = 0; i <= 100; ++i) published += edge.update(edge_at(0.006 * i)) ? 1 : 0;
  EXPECT_EQ(published, 1 + 100 / 4) << "four steps are more than 2 cm";
}

TEST(PublishedEdge, IsPublishedAgainAboutOtherSubmaps) {
  PublishedEdge edge(0);
  EXPECT_TRUE(edge.update(edge_at(1)));
  EXPECT_TRUE(edge.update(edge_at(1, 0, 3)));
}

TEST(PublishedEdge, IsWithdrawnOnceAndCanStandAgain) {
  PublishedEdge edge(0);
  EXPECT_FALSE(edge.update({})) << "nothing was published";
  EXPECT_TRUE(edge.update(edge_at(1)));
  const auto withdrawn = edge.update({});
  ASSERT_TRUE(withdrawn);
  EXPECT_EQ(withdrawn->edge.probability, 0);
  EXPECT_EQ(withdrawn->edge.T_own_other.mean.translation().x(), 1);
  EXPECT_FALSE(edge.stands());
  EXPECT_FALSE(edge.update({}));
  EXPECT_TRUE(edge.update(edge_at(1)));
  EXPECT_TRUE(edge.stands());
}

}  // namespace
}  // namespace cairn::team
