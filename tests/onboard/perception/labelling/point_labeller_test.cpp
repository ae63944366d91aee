// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/point_labeller.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "tests/onboard/perception/labelling/scene.hpp"
#include "tests/support/allocation_count.hpp"

namespace cairn::labelling {
namespace {

using test::kBuilding;
using test::kCar;
using test::kRoad;

struct Labelled {
  LabellingFigures figures;
  std::vector<LabelledPoint> points;
};

Labelled labelled(const LabelImage& labels, const PlacedScan& scan, const SE3& T_odom_base,
                  const LabellingConfig& config = {}) {
  PointLabeller labeller(test::small_camera(), test::mount(), config);
  Labelled result;
  const auto figures = labeller.label(labels, scan, {.T_odom_base = T_odom_base}, result.points);
  EXPECT_TRUE(figures) << to_string(figures.error());
  if (figures) result.figures = *figures;
  const LabellingFigures& f = result.figures;
  EXPECT_EQ(f.seen, f.hidden + f.at_border + f.unlabelled + f.labelled);
  EXPECT_EQ(f.labelled, result.points.size());
  return result;
}

LabelImage uniform(std::uint8_t class_id, int width = 320, int height = 240) {
  LabelImage labels;
  labels.resize(width, height);
  std::fill(labels.classes.begin(), labels.classes.end(), class_id);
  std::fill(labels.probabilities.begin(), labels.probabilities.end(), std::uint8_t{200});
  return labels;
}

SE3 pose(double x, double y, double yaw) { return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished()); }

std::size_t count(const std::vector<LabelledPoint>& points, std::uint8_t class_id) {
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [&](const LabelledPoint& p) { return p.class_id == class_id; }));
}

TEST(PointLabeller, APointGetsTheLabelOfItsPixel) {
  PlacedScan scan;
  scan.T_odom_base = pose(1, 2, 0.3);
  scan.points_base = {{5, 0, 1}, {-5, 0, 1}};
  const Labelled result = labelled(uniform(kCar), scan, scan.T_odom_base);
  ASSERT_EQ(result.points.size(), 1U) << "the other lies behind";
  const LabelledPoint& p = result.points[0];
  EXPECT_EQ(p.class_id, kCar);
  EXPECT_EQ(p.probability, 200);
  EXPECT_EQ(p.weight, 128);
  EXPECT_LT((p.point_odom.cast<double>() - scan.T_odom_base * Eigen::Vector3d(5, 0, 1)).norm(), 1e-5);
}

/// The slow simple version: each point alone, without a z-buffer.
TEST(PointLabeller, WithoutOccludersItIsTheProjectionOfEachPoint) {
  const SE3 T_scan = pose(0.3, 0, 0.05), T_exposure = pose(0, 0.1, -0.04);
  const PlacedScan scan = test::scan_from(T_scan);
  const auto camera = test::small_camera();
  const LabelImage labels = test::picture_from(T_exposure);
  LabellingConfig config;
  config.occlusion_m = 100;
  config.border_px = 0;
  const Labelled result = labelled(labels, scan, T_exposure, config);
  const SE3 T_optical_scan = (T_exposure * test::mount() * cameras::T_camera_optical()).inverse() * T_scan;
  std::size_t next = 0;
  for (const auto& point : scan.points_base) {
    const auto pixel = camera.project(T_optical_scan * point.cast<double>());
    if (!pixel) continue;
    const std::uint8_t class_id = labels.classes[labels.index(static_cast<int>(std::lround(pixel->x())),
                                                              static_cast<int>(std::lround(pixel->y())))];
    if (class_id == kSkyClass) continue;
    ASSERT_LT(next, result.points.size());
    EXPECT_EQ(result.points[next].class_id, class_id);
    EXPECT_LT((result.points[next++].point_odom.cast<double>() - T_scan * point.cast<double>()).norm(), 1e-4);
  }
  EXPECT_EQ(next, result.points.size());
  EXPECT_GT(next, 5000U);
}

TEST(PointLabeller, WhatAnOccluderHidesGetsNoLabel) {
  const PlacedScan scan = test::scan_from(SE3());
  const LabelImage labels = test::picture_from(SE3());
  LabellingConfig careless;
  careless.occlusion_m = 100;
  const Labelled result = labelled(labels, scan, SE3()), without = labelled(labels, scan, SE3(), careless);
  EXPECT_GT(test::wrong_labels(without.points), 50U) << "the LiDAR sees past the car where the camera does not";
  EXPECT_EQ(test::wrong_labels(result.points), 0U);
  EXPECT_GT(count(result.points, kBuilding), 2000U);
  EXPECT_GT(count(result.points, kCar), 1000U);
  EXPECT_GT(count(result.points, kRoad), 1000U);
}

/// As of a VLP-16: the car has gaps of seven pixels in the z-buffer.
TEST(PointLabeller, LasersThatAreFarApartHideWhatIsBetweenThem) {
  const PlacedScan scan = test::scan_from(SE3(), 0.004, 0.035);
  const LabelImage labels = test::picture_from(SE3());
  LabellingConfig near;
  near.occlusion_between_deg = 0;
  const Labelled result = labelled(labels, scan, SE3()), with_gaps = labelled(labels, scan, SE3(), near);
  EXPECT_GT(test::wrong_labels(with_gaps.points), 5U);
  EXPECT_EQ(test::wrong_labels(result.points), 0U);
  EXPECT_EQ(count(result.points, kRoad), count(with_gaps.points, kRoad)) << "the ground hides nothing";
}

/// A laser meets a thing 1.6 m high, the next one above passes it and meets a wall. The camera sees the thing's edge
/// between the two.
TEST(PointLabeller, AThingWithTheSameLabelHidesWhatIsJustAboveItsLastPoint) {
  PlacedScan scan;
  scan.points_base = {{6, 0.3F, 1.5F}, {12, 0.3F, 2.05F}};  // 4 pixels apart
  EXPECT_EQ(labelled(uniform(kCar), scan, SE3()).points.size(), 1U);
  EXPECT_EQ(labelled(uniform(kCar), scan, SE3()).figures.hidden, 1U);
  EXPECT_EQ(labelled(uniform(kRoad), scan, SE3()).points.size(), 2U) << "the ground goes on behind itself";
  LabellingConfig near;
  near.occlusion_between_deg = 0;
  EXPECT_EQ(labelled(uniform(kCar), scan, SE3(), near).points.size(), 2U);
  std::swap(scan.points_base[0], scan.points_base[1]);
  EXPECT_EQ(labelled(uniform(kCar), scan, SE3()).points.size(), 1U) << "in any order";
}

TEST(PointLabeller, TheCameraIsWhereItWasAtTheExposure) {
  const SE3 T_scan = pose(0.6, 0.2, 0.15), T_exposure = pose(0, 0, -0.1);
  const PlacedScan scan = test::scan_from(T_scan);
  const LabelImage labels = test::picture_from(T_exposure);
  const Labelled result = labelled(labels, scan, T_exposure), wrong = labelled(labels, scan, T_scan);
  EXPECT_LT(test::wrong_labels(result.points), result.points.size() / 500);
  EXPECT_GT(result.points.size(), 5000U);
  EXPECT_GT(test::wrong_labels(wrong.points), wrong.points.size() / 10) << "the scan's pose is not the picture's";
}

TEST(PointLabeller, TheOrderOfThePointsChangesNoLabel) {
  PlacedScan scan = test::scan_from(SE3());
  const LabelImage labels = test::picture_from(SE3());
  const auto sorted = [&] {
    auto points = labelled(labels, scan, SE3()).points;
    std::sort(points.begin(), points.end(), [](const LabelledPoint& a, const LabelledPoint& b) {
      return std::lexicographical_compare(a.point_odom.begin(), a.point_odom.end(), b.point_odom.begin(),
                                          b.point_odom.end());
    });
    return points;
  };
  const auto before = sorted();
  std::mt19937 random(7);
  std::shuffle(scan.points_base.begin(), scan.points_base.end(), random);
  const auto after = sorted();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].point_odom, after[i].point_odom);
    EXPECT_EQ(before[i].class_id, after[i].class_id);
    EXPECT_EQ(before[i].weight, after[i].weight);
  }
}

TEST(PointLabeller, BordersOfClassesGiveNoLabel) {
  const PlacedScan scan = test::scan_from(SE3());
  const auto camera = test::small_camera();
  for (const int scale : {1, 2, 4}) {  // the border is of the picture's pixels, however small the label image is
    LabelImage labels = uniform(kCar, 320 / scale, 240 / scale);
    for (int v = 0; v < labels.height; ++v)
      for (int u = labels.width / 2; u < labels.width; ++u) labels.classes[labels.index(u, v)] = kRoad;
    const Labelled result = labelled(labels, scan, SE3());
    const SE3 T_optical_odom = (test::mount() * cameras::T_camera_optical()).inverse();
    double nearest = 1e9;
    for (const LabelledPoint& p : result.points) {
      const double u = camera.project(T_optical_odom * p.point_odom.cast<double>())->x();
      EXPECT_EQ(p.class_id, u < 159.5 ? kCar : kRoad);
      nearest = std::min(nearest, std::abs(u - 159.5));
    }
    EXPECT_GE(nearest, 2 - 1e-3);
    EXPECT_LT(nearest, 2.2);
    EXPECT_GT(result.figures.at_border, 50U);
  }
}

TEST(PointLabeller, SkyAndNoClassGiveNothing) {
  const PlacedScan scan = test::scan_from(SE3());
  for (const std::uint8_t class_id : {kSkyClass, kNoClass, std::uint8_t{19}, std::uint8_t{200}}) {
    const Labelled result = labelled(uniform(class_id), scan, SE3());
    EXPECT_TRUE(result.points.empty());
    EXPECT_EQ(result.figures.unlabelled, result.figures.seen);
  }
}

TEST(PointLabeller, FarPointsGetNoLabel) {
  PlacedScan scan;
  scan.points_base = {{79, 0, 1}, {82, 0, 1}};
  EXPECT_EQ(labelled(uniform(kRoad), scan, SE3()).figures.seen, 1U);
}

TEST(PointLabeller, ALabelImageWithoutItsBytesIsRefused) {
  PointLabeller labeller(test::small_camera(), test::mount(), {});
  std::vector<LabelledPoint> out(3);
  LabelImage labels = uniform(kRoad);
  labels.classes.pop_back();
  EXPECT_EQ(labeller.label(labels, {}, {}, out).error().code, Errc::kMalformed);
  EXPECT_TRUE(out.empty());
  EXPECT_FALSE(labeller.label(LabelImage{}, {}, {}, out));
}

TEST(PointLabeller, NothingIsAllocatedInTheSteadyState) {
  const PlacedScan scan = test::scan_from(SE3());
  const LabelImage labels = test::picture_from(SE3());
  for (const double line_time_us : {0.0, 30.0}) {
    LabellingConfig config;
    config.line_time_us = line_time_us;
    PointLabeller labeller(test::small_camera(), test::mount(), config);
    std::vector<LabelledPoint> out;
    ASSERT_TRUE(labeller.label(labels, scan, {}, out));
    const std::size_t first = out.size(), before = support::allocation_count();
    ASSERT_TRUE(labeller.label(labels, scan, {}, out));
    EXPECT_EQ(support::allocation_count(), before);
    EXPECT_EQ(out.size(), first) << "nothing is left from the scan before";
  }
}

}  // namespace
}  // namespace cairn::labelling
