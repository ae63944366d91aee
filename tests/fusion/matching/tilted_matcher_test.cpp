// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/tilted_matcher.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "fusion/matching/methods.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

SE3 leaning_frame(double roll, double pitch, double yaw) {
  Vector6 v;
  v << 0.037, -0.021, 0.03, roll, pitch, yaw;
  return SE3::from_xyz_rpy(v);
}

/// Two robots in one scene, whose maps' frames lean in any way.
support::MapPair leaning_pair(const support::Scene& scene, const SE3& turn_a, const SE3& turn_b) {
  const support::Stretch of_a{0, 2.2, 14}, of_b{1.0, 3.2, 14};
  const SE3 T_a_world = turn_a * support::pose_on(scene.ride, of_a.from).inverse(),
            T_b_world = turn_b * support::pose_on(scene.ride, of_b.from).inverse();
  return {.name = scene.name,
          .a = support::stretch_map(scene, of_a, T_a_world, 3, 0.1, 10),
          .b = support::stretch_map(scene, of_b, T_b_world, 4, 0.1, 10),
          .T_a_b = T_a_world * T_b_world.inverse()};
}

struct Lean {
  std::string name;
  support::Scene scene;
  SE3 a, b;
};

void PrintTo(const Lean& lean, std::ostream* out) { *out << lean.name; }

class Tilted : public testing::TestWithParam<Lean> {};

TEST_P(Tilted, IsFoundInAllSixDegreesOfFreedom) {
  const auto pair = leaning_pair(GetParam().scene, GetParam().a, GetParam().b);
  const auto a = MapFeatures::build(*pair.a), b = MapFeatures::build(*pair.b);
  Budget budget = Budget::steps(kAmpleSteps);
  const auto result = (*make_matcher("global_6dof", *a, *b))->match(std::nullopt, budget);
  ASSERT_TRUE(result);
  const Vector6 error = (result->T_a_b.mean.inverse() * pair.T_a_b).log();
  EXPECT_LT(error.head<3>().norm(), 0.05);
  EXPECT_LT(error.tail<3>().norm(), 0.005);
  EXPECT_GT(result->probability_correct, 0.5) << result->reason;
}

std::string name_of(const testing::TestParamInfo<Lean>& lean) { return lean.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, Tilted,
                         testing::Values(Lean{"lobby", support::lobby(), leaning_frame(0, 0, 0.7),
                                              leaning_frame(0.6, -0.4, 2)}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(FullScenes, Tilted,
                         testing::Values(Lean{"office", support::office(), leaning_frame(-0.5, 0.3, 1),
                                              leaning_frame(0.4, 1.1, -2)},
                                         Lean{"upside_down", support::office(), leaning_frame(0.2, 0, 0.7),
                                              leaning_frame(std::numbers::pi - 0.3, 0.1, 1)}),
                         name_of);

TEST(Tilted, OfMapsWithNothingInThemSaysSo) {
  const mapping::SemanticOcTree empty(0.1);
  const auto features = MapFeatures::build(empty);
  Budget budget = Budget::steps(kAmpleSteps);
  const auto result = TiltedMatcher(*features, *features).match(std::nullopt, budget);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->accepted);
  EXPECT_FALSE(result->reason.empty());
}

}  // namespace
}  // namespace cairn::matching
