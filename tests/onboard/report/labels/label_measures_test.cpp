// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/labels/label_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "onboard/mapping/files/point_file.hpp"
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

TEST(LabelError, ComparesVoxelWithVoxelWhereTheGridsCoincide) {
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

/// Floor and two walls of another class each, 4 m wide, seen from a frame that is turned and shifted. A voxel has the
/// class of the first point in it; points near a seam between classes are left out.
std::unique_ptr<mapping::SemanticOcTree> corner(const SE3& T_map_world, double edge) {
  auto map = std::make_unique<mapping::SemanticOcTree>(edge);
  const auto add = [&](double x, double y, double z, unsigned class_id) {
    const Eigen::Vector3f p = (T_map_world * Eigen::Vector3d(x, y, z)).cast<float>();
    auto* node = map->updateNode(octomap::point3d(p.x(), p.y(), p.z()), true);
    if (!VoxelLabel::from_id(node->label_id()).any()) node->set_label_id(VoxelLabel::of(class_id, 1).code);
  };
  for (double u = 0.4; u < 4; u += 0.02)
    for (double v = 0.4; v < 4; v += 0.02) {
      add(u, v, 0, kRoadId);
      add(0, u, v, kWallId);
      add(u, 0, v, kCarId);
    }
  return map;
}

TEST(LabelError, TrueLabelsAreRightWhereverTheGridLies) {
  const auto truth = corner({}, 0.1);
  for (const double offset : {0.0, 0.01, 0.03, 0.05, 0.07, 0.0999}) {
    const SE3 T_truth_map = SE3::from_xyz_rpy((Vector6() << offset, -offset, offset, 0, 0, 5 * offset).finished());
    const auto map = corner(T_truth_map.inverse(), 0.1);
    const auto error = label_error(*map, *truth, T_truth_map);
    ASSERT_TRUE(error.has_value());
    EXPECT_NEAR(error->tolerance_m, offset == 0 ? 0.1 : 0.11, 0.011);
    EXPECT_DOUBLE_EQ(*error->confusion.agreement(), 1.0) << offset;
    EXPECT_GT(static_cast<double>(error->common), 0.999 * static_cast<double>(*mapping::listable_voxels(*map)));
  }
}

TEST(LabelError, AWrongClassHasThatOfTheNearestTrueVoxel) {
  const auto truth = row_of({kRoadId, kWallId, kWallId});
  const auto map = row_of({kCarId, kCarId}, 0.03);
  const auto error = label_error(*map, *truth, SE3::from_xyz_rpy((Vector6() << 0.03, 0, 0, 0, 0, 0).finished()));
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->confusion.counts[kRoadId][kCarId], 1U);
  EXPECT_EQ(error->confusion.counts[kWallId][kCarId], 1U);
}

TEST(LabelError, ACoarseMapAndAFarPoseCostNoMoreTime) {
  const auto truth = row_of({kRoadId});
  mapping::SemanticOcTree coarse(1000.0);
  coarse.updateNode(octomap::point3d(1, 1, 1), true);
  EXPECT_EQ(label_error(coarse, *truth, SE3())->common, 0U);
  const SE3 far = SE3::from_xyz_rpy((Vector6() << 1e12, 0, 0, 0, 0, 0).finished());
  EXPECT_EQ(label_error(*truth, *truth, far)->common, 0U);
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
