// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/labels/label_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "onboard/mapping/tree/label_evidence.hpp"
#include "tests/support/hostile_maps.hpp"

namespace cairn::report {
namespace {

using mapping::VoxelLabel;

constexpr unsigned kRoadId = 0, kWallId = 3, kCarId = 13;

/// A row of voxels along x with these classes, from the origin; kNoClass: occupied without label.
std::unique_ptr<mapping::SemanticOcTree> row_of(const std::vector<unsigned>& classes, double shift = 0) {
  auto map = std::make_unique<mapping::SemanticOcTree>(0.1);
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const double x = 0.1 * static_cast<double>(i) + 0.05 + shift;
    auto* node = map->updateNode(octomap::point3d(static_cast<float>(x), 0.05F, 0.05F), true);
    if (classes[i] != kNoClass) node->set_label_id(VoxelLabel::of(classes[i], 1).code);
  }
  return map;
}

TEST(LabelConfusion, GivesAgreementAndIouByHand) {
  LabelConfusion c;
  c.add(kRoadId, kRoadId, 6);
  c.add(kRoadId, kWallId, 2);
  c.add(kWallId, kWallId, 1);
  c.add(kWallId, kCarId, 1);
  EXPECT_EQ(c.total(), 10U);
  EXPECT_DOUBLE_EQ(*c.agreement(), 0.7);
  EXPECT_DOUBLE_EQ(*c.iou(kRoadId), 6.0 / 8);
  EXPECT_DOUBLE_EQ(*c.iou(kWallId), 1.0 / 4);
  EXPECT_DOUBLE_EQ(*c.iou(kCarId), 0.0);
  EXPECT_FALSE(c.iou(5));
  EXPECT_DOUBLE_EQ(*c.miou(3), 0.75);               // the road alone has 3 voxels
  EXPECT_DOUBLE_EQ(*c.miou(1), (0.75 + 0.25) / 2);  // the first labelling has no car
  EXPECT_DOUBLE_EQ(*c.miou(0), (0.75 + 0.25) / 3);
}

TEST(LabelConfusion, OfNothingSaysNothing) {
  const LabelConfusion c;
  EXPECT_FALSE(c.agreement());
  EXPECT_FALSE(c.miou(0));
}

TEST(LabelError, ComparesTheVoxelThatTheCentreLiesIn) {
  const auto truth = row_of({kRoadId, kRoadId, kWallId, kNoClass, kCarId});
  const auto map = row_of({kRoadId, kWallId, kWallId, kCarId, kNoClass, kCarId});
  const auto error = label_error(*map, *truth, SE3());
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->common, 4U);    // truth knows no class of the fourth and nothing of the sixth
  EXPECT_EQ(error->labelled, 3U);  // the map does not label the car
  EXPECT_DOUBLE_EQ(*error->labelled_share(), 0.75);
  EXPECT_DOUBLE_EQ(*error->confusion.agreement(), 2.0 / 3);
}

TEST(LabelError, MovesTheMapIntoTheTrueFrame) {
  const auto truth = row_of({kRoadId, kWallId, kCarId});
  const auto map = row_of({kRoadId, kWallId, kCarId}, 1.0);
  EXPECT_EQ(label_error(*map, *truth, SE3())->common, 0U);
  const SE3 T_truth_map = SE3::from_xyz_rpy((Vector6() << -1, 0, 0, 0, 0, 0).finished());
  EXPECT_DOUBLE_EQ(*label_error(*map, *truth, T_truth_map)->confusion.agreement(), 1.0);
}

TEST(LabelError, OfMapsThatCannotBeListedIsAnError) {
  const auto map = row_of({kRoadId});
  EXPECT_EQ(label_error(*support::whole_tree(2.0F), *map, SE3()).error().code, Errc::kLimit);
  EXPECT_EQ(label_error(*map, *support::whole_tree(2.0F), SE3())->common, 0U);
}

TEST(LabelEntropy, FallsWithTheGrade) {
  double before = 0;
  for (unsigned grade = 0; grade < VoxelLabel::kGrades; ++grade) {
    const double bits = label_entropy(VoxelLabel::of(3, grade).code);
    EXPECT_GT(bits, before);
    EXPECT_LT(bits, std::log2(19.0));
    before = bits;
  }
}

TEST(LabelEntropy, IsThatOfTheEvidence) {
  mapping::LabelEvidence evidence;
  evidence.add(kRoadId, 40);
  const double alone = label_entropy(evidence.id());
  evidence.add(kWallId, 40);
  EXPECT_GT(label_entropy(evidence.id()), alone + 0.5) << "two classes are as likely";
  EXPECT_NEAR(label_entropy(0), std::log2(19.0), 1e-9);
}

}  // namespace
}  // namespace cairn::report
