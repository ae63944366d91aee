// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/growing_match.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "fusion/matching/default_matcher.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

/// Two robots' maps at several times: each robot has gone further along its stretch.
struct Growth {
  explicit Growth(support::Scene s) : scene(std::move(s)) {}
  support::Scene scene;
  GrowingMatch match{};
  SE3 T_a_b{};
  int steps = 0;  // of the newest look

  /// `T_truth_guess`: where a firm guess lies from the truth; none: nobody has said anything.
  void look(const support::Stretch& a, const support::Stretch& b, const std::optional<SE3>& T_truth_guess = {}) {
    const auto pair = support::two_robots(scene, a, b, 3, 2.0, 0.1, 8);
    T_a_b = pair.T_a_b;
    const auto of_a = MapFeatures::build(*pair.a), of_b = MapFeatures::build(*pair.b);
    ASSERT_TRUE(of_a && of_b);
    Budget budget = Budget::steps(kAmpleSteps);
    std::optional<UncertainPose> guess;
    if (T_truth_guess) {
      Vector6 sigma;
      sigma << 0.5, 0.5, 1, 0.03, 0.03, 0.2;
      guess = UncertainPose{T_a_b * *T_truth_guess, sigma.cwiseAbs2().asDiagonal()};
    }
    match.update(*of_a, *of_b, budget, guess, guess.has_value());
    steps = budget.spent();
  }
  [[nodiscard]] double off(const Hypothesis& h) const {
    return (h.T_a_b.mean.inverse() * T_a_b).log().head<3>().norm();
  }
};

TEST(GrowingMatch, MergesInTheLobbyAndNotAtOnce) {
  Growth lobby(support::lobby());
  int looks = 0;
  for (const double to : {1.4, 1.8, 2.2, 2.6, 3.0}) {
    lobby.look({0, to, 4 + 4 * (looks + 1)}, {0.5, 0.5 + to, 4 + 4 * (looks + 1)});
    if (++looks == 1) {
      EXPECT_EQ(lobby.match.hypotheses().accepted(), nullptr);
    }
  }
  ASSERT_NE(lobby.match.hypotheses().accepted(), nullptr) << lobby.match.hypotheses().all()[0].reason;
  EXPECT_LT(lobby.off(*lobby.match.hypotheses().accepted()), 0.05);
}

/// However well maps agree: where a firm guess is wrong they find nothing, and say where they would have.
TEST(GrowingMatch, PlacesElsewhereThanAFirmGuessAreDenied) {
  Growth lobby(support::lobby());
  lobby.look({0, 3, 20}, {0.5, 3.5, 20}, SE3::from_xyz_rpy((Vector6() << 4, 0, 0, 0, 0, 3).finished()));
  for (const Hypothesis& h : lobby.match.hypotheses().all()) EXPECT_GT(lobby.off(h), 1) << "not the true place";
  ASSERT_TRUE(lobby.match.denied());
  EXPECT_LT((lobby.match.denied()->inverse() * lobby.T_a_b).log().head<3>().norm(), 0.05);
  Growth again(support::lobby());
  again.look({0, 3, 20}, {0.5, 3.5, 20}, SE3::from_xyz_rpy((Vector6() << 0.3, 0, 0, 0, 0, 0.1).finished()));
  EXPECT_FALSE(again.match.denied());
  ASSERT_FALSE(again.match.hypotheses().all().empty());
  EXPECT_LT(again.off(again.match.hypotheses().all()[0]), 0.05);
}

TEST(GrowingMatch, SearchesForRivalsBeforeItAcceptsAPlace) {
  GrowingMatchConfig seldom;
  seldom.growth = 1e9;
  Growth lobby(support::lobby());
  lobby.match = GrowingMatch(seldom);
  int first_search = 0;
  for (const double to : {1.4, 1.8, 2.2, 2.6, 3.0, 3.4}) {
    const int scans = static_cast<int>(10 * to), before = lobby.steps;
    const bool was_accepted = lobby.match.hypotheses().accepted() != nullptr;
    lobby.look({0, to, scans}, {0.5, 0.5 + to, scans});
    if (first_search == 0) first_search = lobby.steps;
    if (!was_accepted) continue;
    EXPECT_GT(2 * before, first_search) << "the look that accepted searched, as the first one did";
    return;
  }
  FAIL() << "not accepted";
}

TEST(GrowingMatch, AbstainsInACorridorWithoutEnds) {
  Growth corridor(support::endless_corridor());
  for (const double to : {0.3, 0.6, 0.9}) {
    corridor.look({0, to, 4}, {0.1, 0.1 + to, 4});
    EXPECT_EQ(corridor.match.hypotheses().accepted(), nullptr);
  }
}

/// The same voxels, seen by a robot that leans to its left.
mapping::SemanticOcTree leant_to_the_left(const mapping::SemanticOcTree& map, double rad) {
  mapping::SemanticOcTree turned(map.getResolution());
  const Eigen::AngleAxisf turn(static_cast<float>(rad), Eigen::Vector3f::UnitX());
  const auto voxels = occupied_voxels(map);
  for (const Voxel& v : voxels.value()) {
    const Eigen::Vector3f p = turn * v.centre;
    turned.setNodeValue(octomap::point3d(p.x(), p.y(), p.z()), 2.0F, true);
  }
  turned.canonicalise();
  return turned;
}

TEST(DefaultMatcher, ASearchWithoutAGuessStraightensMapsAndFindsNoPoseThatLeansBesides) {
  const auto pair = support::two_robots(support::lobby(), {0, 2, 8}, {0.5, 2.5, 8}, 3, 2.0, 0.1, 8);
  const auto a = MapFeatures::build(*pair.a);
  ASSERT_TRUE(a);
  constexpr double kMost_rad = 0.21;  // RefinementConfig::most_lean_sigmas
  for (const double rad : {0.0, 0.2}) {
    const mapping::SemanticOcTree map_b = leant_to_the_left(*pair.b, rad);
    const auto b = MapFeatures::build(map_b);
    ASSERT_TRUE(b);
    Budget budget = Budget::steps(kAmpleSteps);
    const auto looks = DefaultMatcher(*a, *b).look_around({}, {}, 8, budget);
    ASSERT_FALSE(looks.empty());
    const Eigen::Matrix3d straight = Eigen::AngleAxisd(-rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const auto lean = [&](const Look& look) {
      return std::acos((look.T_a_b.mean.rotation() * straight.transpose())(2, 2));
    };
    EXPECT_LT(lean(looks.front()), 0.03) << rad;
    for (const Look& look : looks) EXPECT_LT(lean(look), kMost_rad + 0.03) << rad;
  }
}

/// Two rooms alike, door to door with a hall whose far end alone says which side is which.
support::Scene twin_rooms() {
  support::Scene s{"twins", {}, {}};
  s.world.box({0, 0, 0}, {24, 6, 3});
  for (const double x : {0.0, 12.0}) {
    s.world.box({x + 11.9, 0, 0}, {x + 12.1, 2.2, 3}).box({x + 11.9, 3.8, 0}, {x + 12.1, 6, 3});
    s.world.box({x + 2, 0, 0}, {x + 4, 0.8, 1}).box({x + 7, 4.8, 0}, {x + 8, 6, 2});
  }
  s.ride.curve = [](double phi) { return Eigen::Vector2d(2 + 4 * phi, 3); };
  return s;
}

TEST(GrowingMatch, TwoRoomsAlikeAreNotTakenForEachOther) {
  Growth twins(twin_rooms());
  for (const double to : {1.0, 1.6}) {  // a has seen both rooms, b is in the second one
    twins.look({0, 4.8, 20}, {3.2, 3.2 + to, 8});
    const Hypothesis* accepted = twins.match.hypotheses().accepted();
    if (accepted != nullptr) {
      EXPECT_LT(twins.off(*accepted), 0.3);
    }
  }
}

}  // namespace
}  // namespace cairn::matching
