// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/view/distance_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/onboard/client/view/painted_map.hpp"

namespace cairn::client {
namespace {

TEST(Distances, EqualTheSlowSearch) {
  std::mt19937 random(3);
  for (int round = 0; round < 30; ++round) {
    const int width = 1 + static_cast<int>(random() % 20), height = 1 + static_cast<int>(random() % 20);
    std::vector<std::uint8_t> marked(static_cast<std::size_t>(width * height));
    for (auto& m : marked) m = random() % 12 == 0 ? 1 : 0;
    const auto found = distances_2d(marked, width, height, 0.5);
    for (int i = 0; i < width * height; ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (int j = 0; j < width * height; ++j)
        if (marked[static_cast<std::size_t>(j)] != 0)
          nearest = std::min(nearest, 0.5 * std::hypot(i % width - j % width, i / width - j / width));
      if (std::isinf(nearest))
        EXPECT_TRUE(std::isinf(found[static_cast<std::size_t>(i)]));
      else
        EXPECT_NEAR(static_cast<double>(found[static_cast<std::size_t>(i)]), nearest, 1e-5);
    }
  }
}

TEST(DistanceField, TellsHowFarObstaclesAre) {
  test::PaintedMap map;
  map.box({2, -1, -0.2}, {2.1, 1, 1}, true);
  const PlannerView view(map.mirror(), nullptr, std::nullopt);
  const DistanceField field = make_distance_field(view, SE3());
  EXPECT_NEAR(static_cast<double>(field.at({0.05, 0.05, 0.05})), 2.0, 1e-5);
  EXPECT_NEAR(static_cast<double>(field.at({2.05, 1.55, 0.05})), 0.6, 1e-5) << "beside its end";
  EXPECT_NEAR(static_cast<double>(field.at({1.05, 0.05, 1.95})), std::hypot(1.0, 1.0), 1e-5) << "above it";
  EXPECT_EQ(field.at({2.05, 0.05, 0.05}), 0.0F);
}

TEST(DistanceField, IsInfiniteWhereNothingIsKnown) {
  test::PaintedMap empty;
  const PlannerView view(empty.mirror(), nullptr, std::nullopt);
  const DistanceField field = make_distance_field(view, SE3(), {.side_m = 1, .up_m = 1, .down_m = 1});
  EXPECT_TRUE(std::isinf(field.at({0, 0, 0})));
  EXPECT_TRUE(std::isinf(field.at({100, 0, 0}))) << "outside";
  EXPECT_TRUE(std::isinf(field.at({std::numeric_limits<double>::quiet_NaN(), 0, 0})));
}

}  // namespace
}  // namespace cairn::client
