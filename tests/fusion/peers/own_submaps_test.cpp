// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_submaps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/peers/items/claim.hpp"

namespace cairn::peers {
namespace {

constexpr double kTileM = 1.6;

class OwnSubmapsTest : public testing::Test {
 protected:
  void drive(double metres, double step_m) {
    for (double s = 0; s < metres; s += step_m) {
      x_ += step_m;
      submaps_.be_at({x_, 3 * std::sin(x_ / 5), 0}, exchange_);
    }
  }
  [[nodiscard]] Submap said(std::uint16_t submap) const {
    return decode_submap(exchange_.layers().at(1).holding.items().at(ItemId::submap(submap)).payload).value();
  }

  Exchange exchange_{1, "a", Epoch{1} << 32U};
  OwnSubmaps submaps_{{.length_m = 25}, kTileM};
  double x_ = 0;
};

TEST_F(OwnSubmapsTest, AShortRunHasOneAndSaysNothing) {
  submaps_.be_at({1000, 0, 0}, exchange_);  // where odom's origin is does not matter
  for (int i = 0; i < 10'000; ++i) submaps_.be_at({1000 + 0.05 * (i % 2), 0, 0}, exchange_);  // it stands
  EXPECT_EQ(submaps_.current(), 0);
  EXPECT_TRUE(exchange_.layers().at(1).holding.items().empty());
}

TEST_F(OwnSubmapsTest, EachBeginsWhereTheRobotIsOnATileAndDriftsWithThePath) {
  for (std::uint16_t k = 1; k < 5; ++k) {
    while (submaps_.current() < k) drive(0.1, 0.05);
    const UncertainPose T = said(k).T_odom_submap;
    EXPECT_LT((T.mean.translation() - Eigen::Vector3d(x_, 3 * std::sin(x_ / 5), 0)).cwiseAbs().maxCoeff(), 0.81);
    const Eigen::Vector3d tiles = T.mean.translation() / kTileM;
    EXPECT_NEAR((tiles - tiles.array().round().matrix()).norm(), 0, 1e-9);
    EXPECT_NEAR(std::sqrt(T.covariance(1, 1)), 0.25, 0.01);
    EXPECT_NEAR(std::sqrt(T.covariance(5, 5)), 25 * 3.5e-4, 1e-4);
  }
}

TEST_F(OwnSubmapsTest, ABeginningBeginsWithTheFirst) {
  drive(80, 0.5);
  ASSERT_GE(submaps_.current(), 3);
  submaps_.clear();
  EXPECT_EQ(submaps_.current(), 0);
  drive(5, 0.5);
  EXPECT_EQ(submaps_.current(), 0) << "the way before does not count";
}

TEST_F(OwnSubmapsTest, ThereIsALastOne) {
  drive(200 * OwnSubmaps::kMost, 30);
  EXPECT_EQ(submaps_.current(), OwnSubmaps::kMost - 1);
}

}  // namespace
}  // namespace cairn::peers
