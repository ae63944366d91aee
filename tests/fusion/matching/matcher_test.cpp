// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/methods.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/fusion/matching/featured_pair.hpp"

namespace cairn::matching {
namespace {

struct Outcome {
  double m, rad;
};
Outcome error_of(const SE3& estimate, const SE3& truth) {
  const Vector6 e = (estimate.inverse() * truth).log();
  return {e.head<3>().norm(), e.tail<3>().norm()};
}

SE3 start(const SE3& truth, double x, double y, double yaw) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return {truth.quaternion() * turn, truth.translation() + Eigen::Vector3d(x, y, 0)};
}

class OfLobby : public testing::Test {
 protected:
  static const FeaturedPair& lobby() {
    static const FeaturedPair made(support::two_robots(support::lobby(), {0, 2.5, 14}, {1.2, 3.8, 14}, 7));
    return made;
  }
  [[nodiscard]] MatchResult match(const std::optional<UncertainPose>& initial, int steps = kAmpleSteps) const {
    Budget budget = Budget::steps(steps);
    auto result = (*make_matcher("default", a, b))->match(initial, budget);
    EXPECT_TRUE(result);
    return *result;
  }
  const support::MapPair& pair = lobby().pair;
  const MapFeatures &a = lobby().a, &b = lobby().b;
};

TEST_F(OfLobby, EveryCornerOfTheWindowLeadsToTheTruth) {
  for (const double x : {-2.0, 2.0})
    for (const double yaw : {-0.26, 0.26}) {
      const auto r = match(UncertainPose{start(pair.T_a_b, x, -x, yaw), default_prior_covariance()});
      const Outcome e = error_of(r.T_a_b.mean, pair.T_a_b);
      EXPECT_LT(e.m, 0.03);
      EXPECT_LT(e.rad, 0.003);
      EXPECT_TRUE(r.accepted) << r.reason;
      EXPECT_GT(r.probability_correct, 0.9);
      EXPECT_GT(r.overlap, 0.2);
    }
}

TEST_F(OfLobby, WithoutAGuessToo) {
  const auto r = match(std::nullopt);
  const Outcome e = error_of(r.T_a_b.mean, pair.T_a_b);
  EXPECT_LT(e.m, 0.03);
  EXPECT_TRUE(r.accepted) << r.reason;
}

TEST_F(OfLobby, TheSameEveryTime) {
  const UncertainPose initial{start(pair.T_a_b, 1, 1, 0.1), default_prior_covariance()};
  const auto first = match(initial), second = match(initial);
  EXPECT_EQ(first.T_a_b.mean.matrix(), second.T_a_b.mean.matrix());
  EXPECT_EQ(first.T_a_b.covariance, second.T_a_b.covariance);
  EXPECT_EQ(first.probability_correct, second.probability_correct);
}

TEST_F(OfLobby, IsBetterTheMoreStepsItHasAndNeverTakesMore) {
  const UncertainPose initial{start(pair.T_a_b, 1, -1, 0.1), default_prior_covariance()};
  for (const int steps : {1, 2, 20, 60}) {
    const auto r = match(initial, steps);
    EXPECT_LE(r.iterations, steps);
    EXPECT_TRUE(r.T_a_b.mean.matrix().allFinite());
  }
  const auto rough = match(initial, 1), fine = match(initial);
  EXPECT_LE(error_of(fine.T_a_b.mean, pair.T_a_b).m, error_of(rough.T_a_b.mean, pair.T_a_b).m);
}

TEST_F(OfLobby, AGuessThatCannotBeIsRefused) {
  UncertainPose nan{pair.T_a_b, default_prior_covariance()};
  nan.mean = SE3(Eigen::Quaterniond::Identity(), {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  UncertainPose flat{pair.T_a_b, default_prior_covariance()};
  flat.covariance(1, 1) = 0;
  for (const auto& initial : {nan, flat}) {
    Budget budget = Budget::steps(100);
    const auto r = (*make_matcher("default", a, b))->match(initial, budget);
    ASSERT_FALSE(r);
    EXPECT_EQ(r.error().code, Errc::kInvalidConfig);
  }
}

TEST(Matcher, MapsOfDifferentPlacesAreNotAccepted) {
  const auto lobby = support::two_robots(support::lobby(), {0, 2, 8}, {0, 2, 8}, 1);
  const auto forest = support::two_robots(support::forest(), {0, 2, 8}, {0, 2, 8}, 1);
  const auto a = MapFeatures::build(*lobby.a), b = MapFeatures::build(*forest.b);
  ASSERT_TRUE(a && b);
  Budget budget = Budget::steps(kAmpleSteps);
  const auto r = (*make_matcher("default", *a, *b))->match(std::nullopt, budget);
  ASSERT_TRUE(r);
  EXPECT_FALSE(r->accepted);
  EXPECT_LT(r->probability_correct, 0.9);
}

TEST(Matcher, ResolutionsMayDiffer) {
  const support::Scene scene = support::lobby();
  const auto coarse = support::two_robots(scene, {0, 2.5, 14}, {1.2, 3.8, 14}, 7, 2.0, 0.2);
  const auto fine = support::two_robots(scene, {0, 2.5, 14}, {1.2, 3.8, 14}, 7, 2.0, 0.1);
  const auto a = MapFeatures::build(*coarse.a), b = MapFeatures::build(*fine.b);
  ASSERT_TRUE(a && b);
  Budget budget = Budget::steps(kAmpleSteps);
  const auto r = (*make_matcher("default", *a, *b))
                     ->match(UncertainPose{start(fine.T_a_b, 1, 1, 0.2), default_prior_covariance()}, budget);
  ASSERT_TRUE(r);
  EXPECT_LT(error_of(r->T_a_b.mean, fine.T_a_b).m, 0.1);
}

TEST(Matcher, AnUnknownMethodIsNamed) {
  const mapping::SemanticOcTree empty(0.1);
  const auto features = MapFeatures::build(empty);
  const auto matcher = make_matcher("magic", *features, *features);
  ASSERT_FALSE(matcher);
  EXPECT_EQ(matcher.error().code, Errc::kNotFound);
  EXPECT_EQ(matcher.error().where, "magic");
}

}  // namespace
}  // namespace cairn::matching
