// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/drift_history.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace cairn::odometry {
namespace {

SE3 ahead(double metres) { return SE3(Eigen::Quaterniond::Identity(), {metres, 0, 0}); }
Matrix6 of_size(double variance) { return variance * Matrix6::Identity(); }

/// A drift that grows with every step, each direction differently.
Matrix6 drift_after(int step) {
  Vector6 v;
  for (int k = 0; k < 6; ++k) v[k] = 1e-4 * (k + 1) * step;
  return v.asDiagonal();
}

std::vector<KeypointUse> random_uses(std::mt19937& random, float newest, int n) {
  std::uniform_real_distribution<float> weight(0, 1000), epoch(0, newest);
  std::vector<KeypointUse> uses;
  for (int i = 0; i < n; ++i) uses.push_back({i % 7 == 0 ? 0.0F : weight(random), epoch(random)});
  return uses;
}

/// The covariances of all epochs, none forgotten, averaged use by use.
Matrix6 slow_average(const std::vector<Matrix6>& epochs, const std::vector<KeypointUse>& uses) {
  const std::size_t oldest = epochs.size() - std::min(epochs.size(), DriftHistory::kCapacity);
  Matrix6 sum = Matrix6::Zero();
  double total = 0;
  for (const KeypointUse& use : uses) {
    const auto epoch = static_cast<std::size_t>(std::lround(use.epoch));
    sum += static_cast<double>(use.weight) * epochs[std::max(epoch, oldest)];
    total += static_cast<double>(use.weight);
  }
  return sum / total;
}

TEST(DriftHistory, AveragesTheEpochsInUseAsAListOfThemAllDoes) {
  std::mt19937 random(1);
  DriftHistory history;
  std::vector<Matrix6> epochs{drift_after(0)};
  history.reset(ahead(0), epochs[0]);
  history.advance(ahead(0), epochs[0]);
  for (int step = 1; step < 5000; ++step) {
    history.advance(ahead(0.6 * step), drift_after(step));
    epochs.push_back(drift_after(step));
    ASSERT_EQ(history.epoch(), static_cast<float>(step));
    if (step % 250 != 1) continue;
    const auto uses = random_uses(random, history.epoch(), 50);
    const Matrix6 expected = slow_average(epochs, uses);
    EXPECT_LT((history.average(uses) - expected).norm(), 1e-9 * expected.norm()) << step;
  }
}

TEST(DriftHistory, AnEpochIsAStretchOfWayOrATurnAndStandingStillIsNone) {
  DriftHistory history;
  history.reset(ahead(3), of_size(1));
  for (int i = 0; i < 100; ++i) history.advance(ahead(3 + 0.001 * i), of_size(2));
  EXPECT_EQ(history.epoch(), 1) << "ten centimetres";
  for (int i = 0; i < 100; ++i) history.advance(ahead(3 + 0.021 * i), of_size(2));
  EXPECT_EQ(history.epoch(), 5) << "two metres";
  history.advance(ahead(3 + 0.021 * 99) * SE3::exp(0.5 * Vector6::Unit(5)), of_size(2));
  EXPECT_EQ(history.epoch(), 6) << "a turn on the spot";
}

TEST(DriftHistory, OnlyTheFirstScanIsPlacedWithoutTheErrorOfARegistration) {
  DriftHistory history;
  history.reset(ahead(0), Matrix6::Zero());
  history.advance(ahead(0), Matrix6::Zero());
  EXPECT_EQ(history.epoch(), 0);
  history.advance(ahead(0), of_size(4));
  EXPECT_EQ(history.epoch(), 1) << "though nothing moved";
  const std::vector<KeypointUse> both{{3, 0}, {1, 1}}, second{{1, 1}};
  EXPECT_EQ(history.average(both), of_size(1));
  EXPECT_EQ(history.average(second), of_size(4));
}

TEST(DriftHistory, PlanesOfOneEpochHaveItsCovarianceWhateverTheirWeights) {
  DriftHistory history;
  history.reset(ahead(0), of_size(1));
  history.advance(ahead(0), of_size(1));
  history.advance(ahead(1), of_size(4));
  history.advance(ahead(2), of_size(9));
  const std::vector<KeypointUse> middle{{1, 1}, {1e6F, 1}, {1e-3F, 1}};
  EXPECT_EQ(history.average(middle), of_size(4));
  const std::vector<KeypointUse> unused{{0, 2}};
  EXPECT_EQ(history.average(unused), Matrix6::Zero()) << "no use, no error taken over";
  EXPECT_EQ(history.average({}), Matrix6::Zero());
}

TEST(DriftHistory, ResetForgetsEverything) {
  DriftHistory history;
  history.reset(ahead(0), of_size(1));
  for (int step = 1; step < 3000; ++step) history.advance(ahead(step), of_size(step));
  history.reset(ahead(7), of_size(5));
  EXPECT_EQ(history.epoch(), 0);
  const std::vector<KeypointUse> uses{{1, 0}, {1, 2000}};
  EXPECT_EQ(history.average(uses), of_size(5));
}

}  // namespace
}  // namespace cairn::odometry
