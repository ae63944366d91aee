// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/clipped_area.hpp"

#include <gtest/gtest.h>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

using Eigen::Vector3d;

constexpr double kHalf = 0.5;

TEST(ClippedArea, OfATriangleInsideIsItsOwn) {
  EXPECT_NEAR(clipped_area({Vector3d(0, 0, 0), Vector3d(0.4, 0, 0), Vector3d(0, 0.3, 0)}, {0, 0, 0}, kHalf), 0.06,
              1e-12);
}

TEST(ClippedArea, OfAPlaneThroughTheMiddleIsAFace) {
  EXPECT_NEAR(clipped_area({Vector3d(-90, -90, 2), Vector3d(90, -90, 2), Vector3d(0, 90, 2)}, {0, 0, 2}, kHalf), 1.0,
              1e-9);
}

TEST(ClippedArea, OfATriangleOutsideIsNothing) {
  EXPECT_EQ(clipped_area({Vector3d(2, 0, 0), Vector3d(3, 0, 0), Vector3d(2, 1, 0)}, {0, 0, 0}, kHalf), 0.0);
}

// Cubes that fill the space share a triangle among them.
TEST(ClippedArea, OfAllCubesTogetherIsTheTriangle) {
  Random random(5);
  const auto point = [&] { return Vector3d(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)); };
  for (int i = 0; i < 50; ++i) {
    const std::array<Vector3d, 3> t{point(), point(), point()};
    double sum = 0;
    for (int cube = 0; cube < 64; ++cube)
      sum += clipped_area(t, {cube % 4 - 1.5, cube / 4 % 4 - 1.5, cube / 16 - 1.5}, kHalf);
    EXPECT_NEAR(sum, 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace cairn::simulator
