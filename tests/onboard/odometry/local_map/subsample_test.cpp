// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/subsample.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace cairn::odometry {
namespace {

TEST(Subsample, KeepsTheFirstPointOfEveryCubeAsASetWould) {
  std::mt19937 random(9);
  std::normal_distribution<float> normal(0, 8);
  Subsample subsample;
  for (const float edge : {0.1F, 0.5F, 3.0F}) {
    std::vector<Eigen::Vector3f> points(5000);
    for (auto& p : points) p = {normal(random), normal(random), 0.1F * normal(random)};
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0U);
    std::set<std::array<int, 3>> seen;
    std::vector<std::uint32_t> expected;
    for (const std::uint32_t i : all) {
      const Eigen::Vector3f c = (points[i] * (1.0F / edge)).array().floor();
      if (seen.insert({static_cast<int>(c.x()), static_cast<int>(c.y()), static_cast<int>(c.z())}).second)
        expected.push_back(i);
    }
    const auto kept = subsample(points, all, edge);
    EXPECT_EQ(std::vector<std::uint32_t>(kept.begin(), kept.end()), expected) << edge;
  }
}

}  // namespace
}  // namespace cairn::odometry
