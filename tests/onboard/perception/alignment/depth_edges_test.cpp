// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/alignment/depth_edges.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/perception/alignment/sweep.hpp"

namespace cairn::alignment {
namespace {

std::vector<DepthEdge> edges_of(const test::Sweep& s) {
  DepthEdgeFinder finder;
  const auto edges = finder.find(s.cloud, s.points_base, Eigen::Matrix3d::Identity());
  return {edges.begin(), edges.end()};
}

/// The car stands 6 m ahead, 3 m wide and 1.8 m high, before a wall; the ground between is no edge.
TEST(DepthEdges, AreTheSidesAndTheTopOfWhatStandsBeforeAWall) {
  for (const bool numbered : {true, false}) {
    std::size_t sides = 0, tops = 0;
    for (const DepthEdge& e : edges_of(test::sweep(numbered))) {
      EXPECT_NEAR(e.inside_base.x(), 6, 1e-3);
      if (e.kind == EdgeKind::kUpright) {
        EXPECT_LT(std::abs(e.inside_base.y()), 1.5);
        EXPECT_GT(std::abs(e.outside_base.y()), 1.5 - 0.01);
        EXPECT_LT((e.outside_base - e.inside_base).norm(), 0.03) << "one step of the sensor";
        ++sides;
      } else {
        EXPECT_LT(e.inside_base.z(), 1.8);
        EXPECT_GT(e.outside_base.z(), 1.8 - 0.01);
        ++tops;
      }
    }
    EXPECT_GT(sides, 30U) << numbered;
    EXPECT_GT(tops, 50U) << numbered;
  }
}

TEST(DepthEdges, TheNextLaserMayBeFarAway) {
  const auto edges = edges_of(test::sweep(true, 0.035));
  EXPECT_TRUE(std::any_of(edges.begin(), edges.end(), [](const DepthEdge& e) { return e.kind == EdgeKind::kUpright; }));
}

TEST(DepthEdges, WithoutTheSamePointsInBaseLinkThereAreNone) {
  test::Sweep s = test::sweep();
  s.points_base.pop_back();
  EXPECT_TRUE(edges_of(s).empty());
  EXPECT_TRUE(edges_of({}).empty());
}

}  // namespace
}  // namespace cairn::alignment
