// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/point_grid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace cairn::matching {
namespace {

class OfRandomPoints : public testing::Test {
 protected:
  OfRandomPoints() : grid(draw(1500, 1, 4), 0.4F), queries(draw(400, 2, 5)), extra(1500) {
    std::mt19937 random(3);
    for (float& v : extra) v = static_cast<float>(random() % 1000) * 1e-3F;
  }
  static std::vector<Eigen::Vector3f> draw(int n, unsigned seed, float extent) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-extent, extent);
    std::vector<Eigen::Vector3f> points(static_cast<std::size_t>(n));
    for (auto& p : points) p = {at(random), at(random), at(random)};
    return points;
  }
  [[nodiscard]] float squared(std::size_t i, const Eigen::Vector3f& q) const {
    return (grid.points()[i] - q).squaredNorm();
  }

  PointGrid grid;
  std::vector<Eigen::Vector3f> queries;
  std::vector<float> extra;  // a fourth coordinate
};

TEST_F(OfRandomPoints, NearestInMoreDimensionsIsThatOfTryingAll) {
  for (const auto& q : queries)
    for (const float gate : {0.3F, 1.0F, 2.5F}) {
      const auto cost = [&](int i, float d) {
        const float e = extra[static_cast<std::size_t>(i)] - 0.3F;
        return d + 2 * e * e;
      };
      int expected = PointGrid::kNone;
      float least = std::numeric_limits<float>::infinity();
      for (std::size_t i = 0; i < grid.points().size(); ++i) {
        const float c = cost(static_cast<int>(i), squared(i, q));
        if (squared(i, q) < gate * gate && c < least) {
          least = c;
          expected = static_cast<int>(i);
        }
      }
      ASSERT_EQ(grid.nearest(q, gate, cost), expected);
    }
}

TEST_F(OfRandomPoints, TheKNearestAndTheCountAreThoseOfTryingAll) {
  std::vector<PointGrid::Neighbour> found;
  for (const auto& q : queries) {
    std::vector<PointGrid::Neighbour> all;
    for (std::size_t i = 0; i < grid.points().size(); ++i)
      if (squared(i, q) < 1.44F) all.push_back({squared(i, q), static_cast<int>(i)});
    std::sort(all.begin(), all.end());
    EXPECT_EQ(grid.count(q, 1.2F), static_cast<int>(all.size()));
    grid.nearest(q, 1.2F, 6, found);
    ASSERT_EQ(found.size(), std::min<std::size_t>(6, all.size()));
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].index, all[i].index);
  }
}

TEST(PointGrid, AQueryIsBoundedHoweverDenseTheMapAndSmallItsVoxels) {
  const PointGrid heap(std::vector<Eigen::Vector3f>(100'000, Eigen::Vector3f(0.1F, 0.1F, 0.1F)), 0.4F);
  int seen = 0;
  const auto cost = [&](int, float squared) {
    ++seen;
    return squared;
  };
  EXPECT_NE(heap.nearest({0, 0, 0}, 2, cost), PointGrid::kNone);
  EXPECT_LE(seen, PointGrid::kMostLooks);
  EXPECT_LE(heap.count({0, 0, 0}, 2), PointGrid::kMostLooks);
  const PointGrid tiny({{0, 0, 0}}, 1e-5F);
  EXPECT_EQ(tiny.nearest({1, 1, 1}, 2), 0);  // in this lifetime
}

TEST(PointGrid, AnyFloatIsSafeAndNoPointsHaveNoNeighbours) {
  const PointGrid none({}, 0.4F), one({{0, 0, 0}}, 0.4F);
  EXPECT_EQ(none.nearest({0, 0, 0}, 2), PointGrid::kNone);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30F})
    EXPECT_EQ(one.nearest({bad, 0, 0}, 2), PointGrid::kNone);
}

}  // namespace
}  // namespace cairn::matching
