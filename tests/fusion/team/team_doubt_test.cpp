// SPDX-License-Identifier: Apache-2.0
// A robot whose odometry is suddenly wrong and does not know it. What its scans contradict is not shared.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "fusion/peers/items/claim.hpp"
#include "fusion/team/team.hpp"
#include "tests/fusion/team/fleet/riding_robot.hpp"

namespace cairn::team {
namespace {

using peers::Doubt;
using std::chrono::milliseconds;

/// A robot that rides alone, with a batch of tiles for each scan.
class DoubtedRide {
 public:
  explicit DoubtedRide(const support::Scene& scene, double from = 0) : robot_(config(), scene, from, 0.7) {}

  void ride(int scans) {
    for (int i = 0; i < scans; ++i) {
      now_ += milliseconds(500);
      robot_.ride(0.012, now_);
      for (int k = 0; k < 5; ++k) robot_.team.step(now_ + k * milliseconds(100), out_);
      out_.clear();
      doubts_.push_back(robot_.team.doubt());
    }
  }
  void mislead(double metres, double degrees) {
    Vector6 xyz_rpy = Vector6::Zero();
    xyz_rpy[1] = metres;
    xyz_rpy[5] = degrees * M_PI / 180;
    robot_.mislead(SE3::from_xyz_rpy(xyz_rpy));
  }
  [[nodiscard]] std::size_t scans_in_doubt() const {
    return doubts_.size() - static_cast<std::size_t>(std::ranges::count(doubts_, Doubt::kNone));
  }
  [[nodiscard]] const Team& team() const { return robot_.team; }
  [[nodiscard]] std::size_t said() const {
    return static_cast<std::size_t>(robot_.team.exchange().layers().at(1).holding.items().size());
  }
  [[nodiscard]] Doubt doubt() const { return doubts_.back(); }

 private:
  static TeamConfig config() {
    TeamConfig config;
    config.id = 1;
    return config;
  }

  fleet::RidingRobot robot_;
  Time now_{};
  std::vector<peers::Outgoing> out_;
  std::vector<Doubt> doubts_;
};

TEST(TeamDoubt, ARideThatIsWellLocatedIsNeverInDoubt) {
  DoubtedRide ride(support::office());
  ride.ride(60);
  EXPECT_EQ(ride.scans_in_doubt(), 0U);
  EXPECT_EQ(ride.team().held_back().times, 0U);
  EXPECT_GT(ride.said(), 100U);
}

TEST(TeamDoubt, ScansThatContradictTheMapAreHeldBackAndANewSubmapFollows) {
  DoubtedRide ride(support::office());
  ride.ride(30);
  ride.mislead(0.8, 6);
  int noticed = 0;
  for (; noticed < 10 && ride.team().doubt() == Doubt::kNone; ++noticed) ride.ride(1);
  ASSERT_EQ(ride.doubt(), Doubt::kContradicted);
  EXPECT_LE(noticed, 6);
  const std::size_t said = ride.said();
  ride.ride(2);
  EXPECT_EQ(ride.said(), said) << "nothing is said in the meantime";
  ride.ride(60);
  EXPECT_EQ(ride.doubt(), Doubt::kNone) << "the map agrees with the new poses after a while";
  EXPECT_GT(ride.team().held_back().tiles, 0U);
  EXPECT_GE(ride.team().held_back().times, 1U);
  const auto& items = ride.team().exchange().layers().at(1).holding.items();
  const auto submap = items.find(peers::ItemId::submap(1));
  ASSERT_NE(submap, items.end()) << "what follows may bend against what was before";
  const Matrix6 C = peers::decode_submap(submap->second.payload)->T_odom_submap.covariance;
  EXPECT_NEAR(std::sqrt(C(0, 0)), 300 * 0.01, 0.01);
}

class TeamDoubtIn : public ::testing::TestWithParam<int> {};

/// How well right and wrong are told apart: recorded, for each scene.
TEST_P(TeamDoubtIn, ScenesAreNeverInDoubtAndJumpsAlwaysAre) {
  const std::vector<support::Scene> scenes{support::office(), support::lobby(), support::carpark(), support::forest()};
  const auto& scene = scenes[static_cast<std::size_t>(GetParam())];
  for (const double from : {0.0, 1.5, 3.0}) {
    DoubtedRide right(scene, from);
    right.ride(120);
    EXPECT_EQ(right.scans_in_doubt(), 0U) << from;
    DoubtedRide wrong(scene, from);
    wrong.ride(40);
    wrong.mislead(1, 8);
    wrong.ride(10);
    const bool building = GetParam() < 3;  // among trees it is not noticed
    EXPECT_TRUE(wrong.scans_in_doubt() > 0 || !building) << from;
  }
}

INSTANTIATE_TEST_SUITE_P(FullScenes, TeamDoubtIn, ::testing::Range(0, 4));

}  // namespace
}  // namespace cairn::team
