// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/constellations.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "fusion/matching/matcher.hpp"
#include "fusion/matching/search/same_place.hpp"

namespace cairn::matching {
namespace {

/// Two maps with some landmarks in common, and others of their own. b's are in a frame of its own.
struct Skies {
  std::vector<Landmark> a, b;
  float yaw = 0;
  Eigen::Vector2f shift = Eigen::Vector2f::Zero();

  [[nodiscard]] bool is_truth(const Placement& p, const Eigen::Vector2f& middle_b) const {
    const Eigen::Vector2f there = Eigen::Rotation2Df(yaw) * middle_b + shift;
    return same_place(std::hypot(p.x_m - static_cast<double>(there.x()), p.y_m - static_cast<double>(there.y())),
                      std::abs(std::remainder(p.yaw_rad - static_cast<double>(yaw), 2 * std::numbers::pi)));
  }
};

Skies skies(unsigned seed, int common, int others) {
  std::mt19937 random(seed);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random()) / 4294967296.0F;
  };
  Skies s;
  s.yaw = uniform(-3, 3);
  s.shift = {uniform(-60, 60), uniform(-60, 60)};
  const Eigen::Matrix2f back = Eigen::Rotation2Df(-s.yaw).toRotationMatrix();
  const auto place = [&](float low, float high) { return Eigen::Vector2f(uniform(low, high), uniform(0, 40)); };
  const auto strength = [&] { return uniform(2, 20); };
  const auto noise = [&] { return Eigen::Vector2f(uniform(-0.1F, 0.1F), uniform(-0.1F, 0.1F)); };
  for (int i = 0; i < common; ++i) {
    const Eigen::Vector2f at = place(30, 45);
    s.a.push_back({.at = at + noise(), .strength = strength()});
    s.b.push_back({.at = back * (at + noise() - s.shift), .strength = strength()});
  }
  for (int i = 0; i < others; ++i) {
    s.a.push_back({.at = place(0, 30), .strength = strength()});
    s.b.push_back({.at = back * (place(45, 75) - s.shift), .strength = strength()});
  }
  for (auto* all : {&s.a, &s.b})
    std::sort(all->begin(), all->end(), [](const Landmark& l, const Landmark& m) { return l.strength > m.strength; });
  return s;
}

TEST(Constellations, AreFoundWhereAFifthOfTheLandmarksIsShared) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Skies s = skies(seed, 8, 32);
    Budget budget = Budget::steps(kAmpleSteps);
    const Eigen::Vector2f middle_b = s.b.front().at;
    const auto found = constellations(s.a, s.b, middle_b, {}, budget);
    ASSERT_FALSE(found.empty()) << seed;
    EXPECT_TRUE(s.is_truth(found.front(), middle_b)) << seed;
    EXPECT_LE(found.size(), ConstellationConfig{}.placements);
  }
}

TEST(Constellations, CornersThatCrossAnotherWayAreNotTheSame) {
  Skies s = skies(3, 8, 10);
  // All corners of b are turned by 45° against those of a.
  const float turned = 4 * (0.25F * std::numbers::pi_v<float> - s.yaw);
  for (Landmark& l : s.a) l.cross = {1, 0};
  for (Landmark& l : s.b) l.cross = {std::cos(turned), std::sin(turned)};
  Budget budget = Budget::steps(kAmpleSteps);
  const auto found = constellations(s.a, s.b, s.b.front().at, {}, budget);
  for (const Placement& p : found) EXPECT_FALSE(s.is_truth(p, s.b.front().at));
}

TEST(Constellations, EachLandmarkIsAStep) {
  const Skies s = skies(5, 8, 32);
  for (const int steps : {1, 7}) {
    Budget budget = Budget::steps(steps);
    (void)constellations(s.a, s.b, s.b.front().at, {}, budget);
    EXPECT_EQ(budget.spent(), steps);
  }
  Budget budget = Budget::steps(kAmpleSteps);
  (void)constellations(s.a, s.b, s.b.front().at, {}, budget);
  EXPECT_LE(budget.spent(), static_cast<int>(s.b.size()));
}

TEST(Constellations, OfTooFewLandmarksThereAreNone) {
  Budget budget = Budget::steps(kAmpleSteps);
  const std::vector<Landmark> none, one(1),
      far{{.at = {3e4F, -3e4F}}, {.at = {-3e4F, 3e4F}}, {.at = {-3e4F, 3e4F + 9}}};
  EXPECT_TRUE(constellations(none, none, {0, 0}, {}, budget).empty());
  EXPECT_TRUE(constellations(one, one, {0, 0}, {}, budget).empty());
  const auto found = constellations(far, far, {0, 0}, {}, budget);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found.front().x_m, 0, 1e-2);
}

}  // namespace
}  // namespace cairn::matching
