// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/coverage.hpp"

#include <gmock/gmock.h>

#include "tests/onboard/perception/calibration/boards.hpp"

namespace cairn::calibration {
namespace {

using test::kBoard;

TEST(CalibrationCoverage, ViewsThatAreAlikeCountOnce) {
  std::mt19937 random(1);
  const auto camera = *cameras::CameraModel::create(test::small_camera());
  const auto different = test::random_views(camera, kBoard, 10, 0, {}, random);
  std::vector<Corners> views;
  for (int repeat = 0; repeat < 5; ++repeat)
    for (Corners view : different) {
      for (Eigen::Vector2d& p : view) p.x() += 0.1 * repeat;
      views.push_back(view);
    }
  EXPECT_EQ(select_views(kBoard, views, 336, 240, 60).size(), 10U);
  EXPECT_EQ(select_views(kBoard, views, 336, 240, 4).size(), 4U);
  EXPECT_TRUE(select_views(kBoard, {}, 336, 240, 4).empty());
}

TEST(CalibrationCoverage, SaysWhichViewsAreMissing) {
  std::mt19937 random(1);
  const auto camera = *cameras::CameraModel::create(test::small_camera());
  std::vector<Corners> views;
  std::vector<SE3> poses;
  for (int i = 0; i < 4; ++i) {  // in the upper left, its right side towards the camera
    poses.push_back(test::board_at(kBoard, {-0.25, -0.15, 0.5}, {0, 0.5, 0}));
    views.push_back(*test::seen_corners(camera, kBoard, poses.back(), 0, random));
  }
  const Coverage c = coverage(views, poses, 336, 240);
  EXPECT_LT((poses[0] * kBoard.corner(8)).z(), (poses[0] * kBoard.corner(0)).z()) << "the right side is near";
  EXPECT_EQ(c.right_near, 4U);
  EXPECT_EQ(c.left_near, 0U);
  EXPECT_EQ(c.frontal, 0U);
  EXPECT_GT(c.corners[0], 100U);
  EXPECT_EQ(c.corners[8], 0U);
  const auto missing = c.missing();
  EXPECT_THAT(missing, ::testing::Contains(::testing::HasSubstr("lower right")));
  EXPECT_THAT(missing, ::testing::Contains(::testing::HasSubstr("left side")));
  EXPECT_THAT(missing, ::testing::Not(::testing::Contains(::testing::HasSubstr("right side"))));
}

}  // namespace
}  // namespace cairn::calibration
