// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/still_features.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/stereo_view.hpp"

namespace cairn::visual_odometry {
namespace {

/// Three corners at (40, 150), 3 m away: one with a landmark, one with a disparity, one with neither.
class StillFeatures : public ::testing::Test {
 protected:
  StillFeatures() {
    eyes_.line_time_s = 1e-4;
    at_stamp_ = {.T_odom_base = SE3::from_xyz_rpy((Vector6() << 1, 2, 0.5, 0, 0, 0.3).finished()),
                 .twist = (Vector6() << 1, 0, 0, 0, 0.2, 1).finished()};
    const Eigen::Vector3d p_eye = eyes_.point(40, 150, eyes_.fx * eyes_.baseline_m / 3);
    const Eigen::Vector3d later =
        (SE3::exp(eyes_.after_stamp_s(150) * at_stamp_.twist) * kMount).inverse() * (kMount * p_eye);
    at_once_ = eyes_.project(p_eye);
    seen_ = eyes_.project(later);
    for (const std::uint32_t id : {1U, 2U, 3U}) {
      features_.emplace_back();
      features_.back().id = id;
      features_.back().left = seen_.head<2>().cast<float>();
      if (id != 3) features_.back().disparity = static_cast<float>(seen_.z());
    }
    Landmark landmark;
    landmark.p_odom = at_stamp_.T_odom_base * kMount * p_eye;
    landmarks_.take(1, landmark);
  }
  [[nodiscard]] static Eigen::Vector3d where(const Feature& f) {
    return {f.left.x(), f.left.y(), f.disparity.value_or(0)};
  }

  static inline const SE3 kMount =
      SE3::from_xyz_rpy((Vector6() << 0.1, 0, 0, 0, 0.2, 0).finished()) * cameras::T_camera_optical();
  stereo::StereoGeometry eyes_ = support::small_eyes();
  odometry::MotionState at_stamp_;
  Eigen::Vector3d at_once_, seen_;  // left pixel, disparity
  LandmarkMap landmarks_{eyes_, {}, 40};
  std::vector<Feature> features_;
};

TEST_F(StillFeatures, AreWhereOneExposureWouldShowThem) {
  ASSERT_GT((at_once_ - seen_).norm(), 1);
  hold_still(features_, landmarks_, {eyes_, kMount, at_stamp_});
  EXPECT_LT((where(features_[0]) - at_once_).norm(), 0.1) << "by its landmark";
  EXPECT_LT((where(features_[1]) - at_once_).norm(), 0.1) << "by its disparity";
  EXPECT_EQ(features_[2].left, seen_.head<2>().cast<float>()) << "its distance is not known";
}

TEST_F(StillFeatures, StayWhereTheBaseIsAtRest) {
  at_stamp_.twist.setZero();
  hold_still(features_, landmarks_, {eyes_, kMount, at_stamp_});
  for (const Feature& f : features_) EXPECT_LT((where(f).head<2>() - seen_.head<2>()).norm(), 1e-4);
}

}  // namespace
}  // namespace cairn::visual_odometry
