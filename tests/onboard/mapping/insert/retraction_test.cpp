// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/retraction.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "onboard/mapping/mapper.hpp"

namespace cairn::mapping {
namespace {

using Points = std::vector<Eigen::Vector3f>;

MappingConfig small_map() {
  MappingConfig config;
  config.resolution_m = 0.1;
  config.reserve_mb = 1;
  return config;
}

/// A wall behind somebody who stands before it in one scan.
Points wall() {
  Points points;
  for (int y = -20; y <= 20; ++y)
    for (int z = -8; z <= 8; ++z)
      points.emplace_back(5.05F, 0.1F * static_cast<float>(y), 0.1F * static_cast<float>(z));
  return points;
}
Points body() {
  Points points;
  for (int z = -8; z <= 8; ++z) points.emplace_back(3.05F, 0.05F, 0.1F * static_cast<float>(z));
  return points;
}

struct Map {
  Workers workers{1};
  Mapper mapper{small_map(), workers};
  void insert(const Points& points) { ASSERT_TRUE(mapper.insert(points, Eigen::Vector3f::Zero())); }
  [[nodiscard]] const SemanticNode* at(const Eigen::Vector3f& p) const {
    return mapper.tree().search(p.x(), p.y(), p.z());
  }
};

TEST(Retraction, WhatOneScanPutThereIsGone) {
  Map map;
  map.insert(wall());
  map.insert(body());
  (void)map.mapper.take_changed_tiles();
  EXPECT_GT(map.mapper.take_back(body()), 10U);
  for (const auto& p : body()) EXPECT_FALSE(map.mapper.tree().isNodeOccupied(map.at(p)));
  for (const auto& p : wall()) EXPECT_TRUE(map.mapper.tree().isNodeOccupied(map.at(p)));
  EXPECT_FALSE(map.mapper.changed_tiles().empty());
  EXPECT_TRUE(map.mapper.tree().is_canonical());
}

/// One hit fewer and one miss more, as OctoMap would count them.
TEST(Retraction, CountsAsOneMissInsteadOfOneHit) {
  Map map, expected;
  for (int i = 0; i < 3; ++i) map.insert(body());
  for (int i = 0; i < 2; ++i) expected.insert(body());
  map.mapper.take_back(body());
  const float miss = map.mapper.tree().sensor_model().miss;
  for (const auto& p : body()) EXPECT_NEAR(map.at(p)->getLogOdds(), expected.at(p)->getLogOdds() + miss, 1e-5);
}

TEST(Retraction, FreeUnknownAndImpossiblePlacesStayAsTheyAre) {
  Map map;
  map.insert(wall());
  const auto before = map.mapper.tree().size();
  constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(map.mapper.take_back(Points{{2, 0, 0}, {-4, 3, 1}, {kNotANumber, 0, 0}, {1e9F, 0, 0}}), 0U);
  EXPECT_EQ(map.mapper.take_back({}), 0U);
  EXPECT_EQ(map.mapper.tree().size(), before);
}

TEST(Retraction, AVoxelCountsOnceAndItsLabelGoesWithIt) {
  Map map;
  map.insert(body());
  std::vector<LabelledPoint> labels;
  for (const auto& p : body()) labels.push_back({p, 11, 250, 255});
  map.mapper.label(labels);
  ASSERT_NE(map.at(body()[8])->label_id(), 0U);
  Points twice = body();
  twice.insert(twice.end(), twice.begin(), twice.end());
  map.mapper.take_back(twice);
  const auto& model = map.mapper.tree().sensor_model();
  for (const auto& p : body()) {
    EXPECT_NEAR(map.at(p)->getLogOdds(), model.miss, 1e-5);
    EXPECT_EQ(map.at(p)->label_id(), 0U);
  }
}

TEST(Mapper, StandingIsWhatHasBeenSeenAgainAndAgain) {
  Map map;
  const Eigen::Vector3f before = 0.5F * wall()[40];  // on the ray
  EXPECT_EQ(map.mapper.standing(wall()[40]), Standing::kUnknown);
  map.insert(wall());
  EXPECT_EQ(map.mapper.standing(wall()[40]), Standing::kOccupied);
  for (int i = 0; i < 3; ++i) map.insert(wall());
  EXPECT_EQ(map.mapper.standing(wall()[40]), Standing::kSettled);
  EXPECT_EQ(map.mapper.standing(before), Standing::kFree);
  EXPECT_EQ(map.mapper.standing({2, 0, 50}), Standing::kUnknown);
  EXPECT_EQ(map.mapper.standing({std::numeric_limits<float>::quiet_NaN(), 0, 0}), Standing::kUnknown);
}

}  // namespace
}  // namespace cairn::mapping
