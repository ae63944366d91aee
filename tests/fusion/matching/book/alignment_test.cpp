// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/alignment.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::matching {
namespace {

TEST(Alignment, FindsTheMotionExactly) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-5, 5);
  for (int trial = 0; trial < 20; ++trial) {
    Vector6 xi;
    for (double& v : xi) v = at(random) / 3;
    const SE3 T = SE3::exp(xi);
    Alignment pairs;
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d x(at(random), at(random), trial % 2 == 0 ? 0 : at(random));  // a plane must not be mirrored
      pairs.add(x, T * x, 0.1 + std::abs(at(random)));
    }
    EXPECT_LT((pairs.solve().inverse() * T).log().norm(), 1e-9);
  }
}

TEST(Alignment, NoSmallMotionIsBetter) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> at(-5, 5);
  std::vector<std::array<Eigen::Vector3d, 2>> pairs;
  std::vector<double> weights;
  Alignment alignment;
  for (int i = 0; i < 30; ++i) {
    pairs.push_back(
        {Eigen::Vector3d(at(random), at(random), at(random)), Eigen::Vector3d(at(random), at(random), at(random))});
    weights.push_back(std::abs(at(random)));
    alignment.add(pairs.back()[0], pairs.back()[1], weights.back());
  }
  const auto cost = [&](const SE3& T) {
    double sum = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) sum += weights[i] * (T * pairs[i][0] - pairs[i][1]).squaredNorm();
    return sum;
  };
  const SE3 best = alignment.solve();
  for (int k = 0; k < 6; ++k)
    for (const double step : {-1e-3, 1e-3}) EXPECT_GT(cost(best * SE3::exp(step * Vector6::Unit(k))), cost(best));
}

TEST(Alignment, TooFewPairsGiveNoMotion) {
  Alignment pairs;
  pairs.add({1, 2, 3}, {4, 5, 6});
  EXPECT_EQ(pairs.solve().matrix(), Eigen::Matrix4d::Identity());
  EXPECT_NEAR(pairs.mean_squared(), 27, 1e-12);
}

}  // namespace
}  // namespace cairn::matching
