// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/fused_entropies.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "onboard/mapping/tree/label_evidence.hpp"

namespace cairn::protocol {
namespace {

constexpr double kResolution = 0.2;
constexpr std::uint8_t kCarClass = 13, kRoadClass = 0;

/// A row of voxels from `first` on, with log-odds of 1 and `steps` of evidence for a class; 0: without a label.
std::shared_ptr<mapping::SemanticOcTree> row_of(int first, int count, std::uint8_t class_id, unsigned steps) {
  auto map = std::make_shared<mapping::SemanticOcTree>(kResolution);
  mapping::LabelEvidence evidence;
  if (steps > 0) evidence.add(class_id, steps);
  for (int i = first; i < first + count; ++i) {
    auto* node = map->updateNode(kResolution * (i + 0.5), 0.1, 0.1, 1.0F, false);
    node->setLogOdds(1.0F);
    node->set_label_id(evidence.id());
  }
  map->canonicalise();
  return map;
}

MapPair pair_of(std::shared_ptr<mapping::SemanticOcTree> a, std::shared_ptr<mapping::SemanticOcTree> b) {
  MapPair pair;
  pair.name = pair.scene = "row";
  pair.a = std::move(a);
  pair.b = std::move(b);
  return pair;
}

FusedEntropies fused(const MapPair& pair, const SE3& T_a_b = {}) {
  auto done = fuse_pair(pair, T_a_b);
  EXPECT_TRUE(done) << to_string(done.error());
  return done->entropies;
}

double binary(double log_odds) {
  const double p = 1 / (1 + std::exp(-log_odds));
  return -p * std::log2(p) - (1 - p) * std::log2(1 - p);
}

TEST(FusedEntropies, WhatBothKnowBecomesSurer) {
  const auto e = fused(pair_of(row_of(0, 8, kCarClass, 20), row_of(0, 8, kCarClass, 20)));
  for (const EntropiesOfThree& three : {e.whole, e.shared}) {
    EXPECT_EQ(three.fused.occupied, 8U);
    EXPECT_EQ(three.fused.labelled, 8U);
    EXPECT_NEAR(three.a.occupancy, binary(1), 1e-6);
    EXPECT_NEAR(three.fused.occupancy, binary(2), 1e-6);
    EXPECT_LT(three.fused.label, three.a.label);
    EXPECT_LT(three.fused.overall(), three.a.overall());
  }
}

TEST(FusedEntropies, WhatOneRobotAloneKnowsStaysAsItIs) {
  const auto e = fused(pair_of(row_of(0, 8, kCarClass, 20), row_of(20, 4, kRoadClass, 5)));
  EXPECT_EQ(e.whole.fused.occupied, 12U);
  EXPECT_NEAR(e.whole.fused.occupancy, binary(1), 1e-6);
  EXPECT_NEAR(e.whole.fused.label, (8 * e.whole.a.label + 4 * e.whole.b.label) / 12, 1e-6);
  EXPECT_EQ(e.shared.fused.occupied, 0U);
  EXPECT_EQ(e.shared.fused.overall(), 0);
}

TEST(FusedEntropies, LabelsOfVoxelsWithoutAPartnersLabelAreNotCompared) {
  const auto e = fused(pair_of(row_of(0, 8, kCarClass, 20), row_of(0, 8, kCarClass, 0)));
  EXPECT_EQ(e.shared.a.labelled, 0U);
  EXPECT_EQ(e.whole.b.labelled, 0U);
  EXPECT_EQ(e.whole.fused.labelled, 8U);
  EXPECT_EQ(e.whole.b.label, 0);
}

TEST(FusedEntropies, AVoxelGoesToTheNeighbourOfItsClass) {
  auto two = row_of(0, 1, kRoadClass, 20);
  mapping::LabelEvidence car;
  car.add(kCarClass, 20);
  auto* beside = two->updateNode(0.3, 0.1, 0.1, 1.0F, false);
  beside->setLogOdds(1.0F);
  beside->set_label_id(car.id());
  const auto e = fused(pair_of(two, row_of(0, 1, kCarClass, 20)));
  EXPECT_EQ(e.whole.fused.occupied, 2U);
  EXPECT_EQ(e.shared.fused.labelled, 1U);
  EXPECT_LT(e.shared.fused.label, e.shared.a.label) << "both say car";
}

TEST(FusedEntropies, BeyondAVoxelsDiagonalNothingIsFused) {
  const auto e = fused(pair_of(row_of(0, 1, kCarClass, 20), row_of(2, 1, kCarClass, 20)));
  EXPECT_EQ(e.whole.fused.occupied, 2U);
  EXPECT_EQ(e.shared.fused.occupied, 0U);
}

TEST(FusedEntropies, TheOtherMapIsMovedFirst) {
  const SE3 T_a_b(Eigen::Quaterniond::Identity(), Eigen::Vector3d(20 * kResolution, 0, 0));
  const auto e = fused(pair_of(row_of(20, 8, kCarClass, 20), row_of(0, 8, kCarClass, 20)), T_a_b);
  EXPECT_EQ(e.shared.fused.occupied, 8U);
  EXPECT_EQ(e.told.fused.occupied, 8U);
  EXPECT_EQ(e.told.fused.labelled, 8U);
}

TEST(FusedEntropies, ATeamsMapHasTheGradesThatRobotsExchange) {
  const auto e = fused(pair_of(row_of(0, 8, kCarClass, 20), row_of(0, 8, kCarClass, 20)));
  EXPECT_EQ(e.told.a.occupied, 8U);
  EXPECT_LE(e.told.fused.label, e.told.a.label);
  EXPECT_NEAR(e.told.a.occupancy, e.told.fused.occupancy, 1e-6);  // equal opinions stay as they are
}

TEST(FusedEntropies, TwoResolutionsAreRefused) {
  MapPair pair = pair_of(row_of(0, 8, kCarClass, 20), std::make_shared<mapping::SemanticOcTree>(0.1));
  const auto done = fuse_pair(pair, {});
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace cairn::protocol
