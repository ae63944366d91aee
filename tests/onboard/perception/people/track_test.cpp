// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/track.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn::people {
namespace {

using Eigen::Vector2d;
using test::kScan;

constexpr double kNoise = 0.12;  // m

Time at(int scan) { return Time{std::chrono::seconds(5)} + scan * kScan; }

/// Somebody who walks along x, measured with noise.
Track walked(int scans, double speed, unsigned seed = 1, double sigma = kNoise) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma);
  Track track(at(0), {noise(random), noise(random)}, 0, 0);
  for (int i = 1; i < scans; ++i) {
    track.predict(at(i));
    track.update({0.1 * i * speed + noise(random), noise(random)}, kNoise, 0);
  }
  return track;
}

TEST(Track, FindsTheVelocity) {
  const Track track = walked(30, 1.3);
  EXPECT_NEAR(track.person().velocity.x(), 1.3, 0.35);
  EXPECT_NEAR(track.person().velocity.y(), 0, 0.35);
  EXPECT_NEAR(track.person().position.x(), 0.1 * 29 * 1.3, 0.2);
}

/// The mean of the squared error, in units of the covariance, is 2 for two directions.
TEST(Track, ItsCovarianceIsHonest) {
  double sum = 0;
  constexpr int kRuns = 300;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const Person person = walked(20, 1, seed).person();
    const Vector2d error = person.position - Vector2d(1.9, 0);
    sum += error.dot(person.covariance.inverse() * error);
  }
  EXPECT_GT(sum / kRuns, 0.8) << "somebody who turns needs room: it may be too careful";
  EXPECT_LT(sum / kRuns, 2.4);
}

TEST(Track, APredictionGrowsUncertain) {
  Track track = walked(10, 1);
  const double before = track.person().covariance.trace();
  track.predict(at(12));
  EXPECT_GT(track.person().covariance.trace(), before);
  EXPECT_FALSE(track.person().seen);
  EXPECT_EQ(track.last_seen(), at(9));
}

TEST(Track, KnowsWhoWalks) {
  EXPECT_TRUE(walked(20, 1.2, 1, 0.06).walked());
  EXPECT_FALSE(walked(20, 0).walked()) << "noise is no walk";
  EXPECT_FALSE(walked(5, 1.2).walked()) << "too short";
  EXPECT_FALSE(walked(20, 6).walked()) << "no person is so fast";
}

TEST(Track, EvidenceHasBounds) {
  Track track = walked(2, 0);
  for (int i = 0; i < 100; ++i) track.weigh(3);
  const double most = track.evidence();
  for (int i = 0; i < 5; ++i) track.weigh(-2);
  EXPECT_LT(track.evidence(), 0) << "five pictures must undo whatever was believed";
  EXPECT_LE(most, 10);
}

TEST(Track, RemembersTwoSeconds) {
  const Track track = walked(60, 1);
  EXPECT_LE(track.steps().size(), 21U);
  EXPECT_EQ(track.steps().back().stamp, at(59));
}

}  // namespace
}  // namespace cairn::people
