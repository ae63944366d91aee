// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/row_motion.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/stereo_view.hpp"

namespace cairn::stereo {
namespace {

const Vector6 kFast = (Vector6() << 2, 0.1, -0.1, 0.2, -0.1, 1).finished();

TEST(RowMotion, IsThatOfTheBaseToFirstOrder) {
  const Eigen::Vector3d p(4, -1, 0.5);
  const RowMotion motion{kFast, 0.01};
  const Eigen::Vector3d exact = SE3::exp(0.01 * kFast).inverse() * p;
  EXPECT_LT((motion.at_row(p) - exact).norm(), 5e-4);
  EXPECT_GT((p - exact).norm(), 0.03);
  EXPECT_LT((motion.at_stamp(motion.at_row(p)) - p).norm(), 1e-3);
}

TEST(RowMotion, NothingMovesAtTheStampOrAtRest) {
  const Eigen::Vector3d p(4, -1, 0.5);
  EXPECT_EQ((RowMotion{kFast, 0}).at_row(p), p);
  EXPECT_EQ((RowMotion{Vector6::Zero(), 0.01}).at_stamp(p), p);
}

/// A point is at one place; a rolling shutter shows it from where the base is when its row is exposed.
TEST(HoldStill, PutsPointsToWhereTheyWereAtTheStamp) {
  StereoGeometry eyes = support::small_eyes();
  eyes.line_time_s = 1e-4;
  const SE3 T_base_eye = SE3::from_xyz_rpy((Vector6() << 0.1, 0, 0, 0, 0.2, 0).finished()) *
                         SE3(Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), Eigen::Vector3d::Zero());
  std::vector<Eigen::Vector3f> points_eye, points_base;
  std::vector<Eigen::Vector3d> at_stamp;
  for (const double row : {0.0, 80.0, 159.0}) {
    const Eigen::Vector3d seen = eyes.point(200, row, 3);
    points_eye.push_back(seen.cast<float>());
    points_base.push_back((T_base_eye * seen).cast<float>());
    at_stamp.emplace_back(SE3::exp(eyes.after_stamp_s(row) * kFast) * T_base_eye * seen);
  }
  hold_still(eyes, kFast, points_eye, points_base);
  for (std::size_t i = 0; i < at_stamp.size(); ++i)
    EXPECT_LT((points_base[i].cast<double>() - at_stamp[i]).norm(), 2e-3) << i;
  const auto before = points_base;
  eyes.line_time_s = 0;
  hold_still(eyes, kFast, points_eye, points_base);
  EXPECT_EQ(points_base, before);
}

}  // namespace
}  // namespace cairn::stereo
