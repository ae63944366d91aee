// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/wall_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cairn::people {
namespace {

constexpr int kSide = 60;
constexpr float kCell = 0.12F;

std::uint32_t cell_at(const Eigen::Vector2f& p) {
  return static_cast<std::uint32_t>(static_cast<int>(p.y() / kCell) * kSide + static_cast<int>(p.x() / kCell));
}

class WallCellsTest : public ::testing::Test {
 protected:
  void put(const Eigen::Vector2f& p) { cells_.add(cell_at(p), p); }
  /// Points every 2 cm from `from`, with the noise of a LiDAR across the line.
  void put_line(const Eigen::Vector2f& from, float angle, float length_m) {
    const Eigen::Vector2f along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    for (float at = 0; at < length_m; at += 0.02F) put(from + at * along + noise_(random_) * across);
  }

  WallCells cells_{kSide};
  std::mt19937 random_{1};
  std::normal_distribution<float> noise_{0, 0.02F};
};

TEST_F(WallCellsTest, AStraightLineOfAnyDirectionIsAWall) {
  for (const float angle : {0.0F, 0.4F, 0.785F, 1.57F}) {
    cells_.clear();
    put_line({1, 1}, angle, 2);
    cells_.judge();
    const Eigen::Vector2f middle = Eigen::Vector2f(1, 1) + Eigen::Vector2f(std::cos(angle), std::sin(angle));
    bool wall = false;  // noise may put the line beside the middle's cell
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        wall |= cells_.is_wall(cell_at(middle + 0.06F * Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y))));
    EXPECT_TRUE(wall) << angle;
  }
}

TEST_F(WallCellsTest, AShortFlatThingIsNone) {
  put_line({3, 3}, 0, 0.5F);  // as broad as a person
  cells_.judge();
  EXPECT_FALSE(cells_.is_wall(cell_at({3.25F, 3})));
}

TEST_F(WallCellsTest, NeitherIsARoundBodyNorACorner) {
  for (float angle = 0; angle < 3.1F; angle += 0.05F)
    put(Eigen::Vector2f(2, 2) + 0.4F * Eigen::Vector2f(std::cos(angle), std::sin(angle)));
  put_line({4, 4}, 0, 1);
  put_line({4, 4}, 1.57F, 1);
  cells_.judge();
  EXPECT_FALSE(cells_.is_wall(cell_at({2, 2.4F})));
  EXPECT_FALSE(cells_.is_wall(cell_at({4.03F, 4.03F})));
}

TEST_F(WallCellsTest, NothingIsLeftOfTheScanBefore) {
  put_line({1, 3}, 0, 2);
  cells_.judge();
  ASSERT_TRUE(cells_.is_wall(cell_at({2, 3.01F})) || cells_.is_wall(cell_at({2, 2.99F})));
  cells_.clear();
  cells_.judge();
  for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) EXPECT_FALSE(cells_.is_wall(cell));
}

/// Beside somebody, a wall's cells count as before: the body's points must not be taken for the wall's.
TEST_F(WallCellsTest, SomebodyInFrontOfAWallIsNotPartOfIt) {
  put_line({1, 3}, 0, 3);
  for (float angle = 3.2F; angle < 6.2F; angle += 0.1F)
    put(Eigen::Vector2f(2.5F, 2.8F) + 0.2F * Eigen::Vector2f(std::cos(angle), std::sin(angle)));
  cells_.judge();
  EXPECT_FALSE(cells_.is_wall(cell_at({2.5F, 2.6F})));
}

}  // namespace
}  // namespace cairn::people
