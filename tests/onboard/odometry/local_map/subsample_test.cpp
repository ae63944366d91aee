// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/subsample.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <vector>

namespace cairn::odometry {
namespace {

std::vector<std::uint32_t> every_index(const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

std::array<int, 3> cube_of(const Eigen::Vector3f& p, float edge) {
  const Eigen::Vector3f c = (p * (1.0F / edge)).array().floor();
  return {static_cast<int>(c.x()), static_cast<int>(c.y()), static_cast<int>(c.z())};
}

std::vector<std::array<int, 3>> cubes_as_met(const std::vector<Eigen::Vector3f>& points,
                                             std::span<const std::uint32_t> which, float edge) {
  std::set<std::array<int, 3>> seen;
  std::vector<std::array<int, 3>> out;
  for (const std::uint32_t i : which)
    if (const auto cube = cube_of(points[i], edge); seen.insert(cube).second) out.push_back(cube);
  return out;
}

TEST(Subsample, KeepsOnePointOfEveryCubeAsASetWould) {
  std::mt19937 random(9);
  std::normal_distribution<float> normal(0, 8);
  Subsample subsample;
  for (const float edge : {0.1F, 0.5F, 3.0F}) {
    std::vector<Eigen::Vector3f> points(5000);
    for (auto& p : points) p = {normal(random), normal(random), 0.1F * normal(random)};
    const auto all = every_index(points);
    const auto kept = subsample(points, all, edge);
    const auto expected = cubes_as_met(points, all, edge);
    EXPECT_EQ(kept.size(), expected.size()) << edge;
    EXPECT_EQ(cubes_as_met(points, kept, edge), expected) << edge;
  }
}

TEST(Subsample, EveryPointOfACubeHasTheSameChance) {
  constexpr std::size_t kCubes = 6000, kPoints = 6;
  std::vector<Eigen::Vector3f> points;
  for (std::size_t cube = 0; cube < kCubes; ++cube)
    points.insert(points.end(), kPoints, {static_cast<float>(cube) + 0.5F, 0.5F, 0.5F});
  Subsample subsample;
  std::array<int, kPoints> chosen{};
  for (const std::uint32_t i : subsample(points, every_index(points), 1.0F)) ++chosen[i % kPoints];
  for (const int times : chosen) EXPECT_NEAR(times, 1000, 4 * std::sqrt(1000 * 5.0 / 6));
}

/// One ring over a wall that is 2 m ahead, in steps of 0.2°, from −60° to 60°: first it comes nearer, then it recedes.
std::vector<Eigen::Vector3f> sweep_over_wall(std::mt19937& random) {
  std::normal_distribution<float> noise(0, 0.02F);
  std::vector<Eigen::Vector3f> points;
  for (int step = -300; step <= 300; ++step) {
    const float azimuth = static_cast<float>(step) * 0.2F * std::numbers::pi_v<float> / 180;
    const float range = 2 / std::cos(azimuth) + noise(random);
    points.emplace_back(range * std::cos(azimuth), range * std::sin(azimuth), 0.01F);
  }
  return points;
}

/// Noise makes a point enter a cube early. So the first in scan order lie 9 mm in front of the wall where the sweep
/// comes nearer, and 9 mm behind it where it recedes. A robot that stands would seem to turn.
TEST(Subsample, WhatIsKeptLiesOnTheWallWhicheverWayTheSweepGoes) {
  std::mt19937 random(11);
  Subsample subsample;
  std::array<double, 2> beyond_m{};
  std::array<int, 2> kept{};
  for (int sweep = 0; sweep < 300; ++sweep) {
    const auto points = sweep_over_wall(random);
    for (const std::uint32_t i : subsample(points, every_index(points), 0.3F)) {
      const std::size_t half = points[i].y() > 0 ? 1 : 0;
      beyond_m[half] += points[i].x() - 2;
      ++kept[half];
    }
  }
  for (const std::size_t half : {0U, 1U}) EXPECT_NEAR(beyond_m[half] / kept[half], 0, 1e-3) << "3 σ of its noise";
}

}  // namespace
}  // namespace cairn::odometry
