// SPDX-License-Identifier: Apache-2.0
// A robot without a LiDAR that dies on its flight and goes on from what it saved.
#include <gtest/gtest.h>

#include "onboard/app/restart/saved_keyframes.hpp"
#include "onboard/robot.hpp"
#include "tests/support/stereo_view.hpp"

namespace cairn {
namespace {

RobotConfig flying() {
  StereoSetup eyes;
  eyes.geometry = support::small_eyes();
  eyes.odometry.tracking.features = 120;
  eyes.odometry.tracking.spacing_px = 12;
  RobotConfig config;
  config.mapping.reserve_mb = 1;
  config.stereo = eyes;
  return config;
}

/// A slow flight forward through the furnished room, ten pictures a second.
class StereoResume : public testing::Test {
 protected:
  /// Looks at one picture. Its points are one, 2 m ahead.
  TrackPoint look(Robot& robot, const SE3& T_world_base, double t) {
    view_.shoot(T_world_base * cameras::T_camera_optical(), Time{from_seconds(t)}, pair_);
    Budget budget = Budget::steps(visual_odometry::most_steps({}));
    const auto point = robot.locate(pair_, budget, located_);
    EXPECT_TRUE(point);
    if (robot.new_keyframe() != nullptr) keyframes_.push_back(*robot.new_keyframe());
    located_.points_base = {{2, 0, 0}};
    EXPECT_TRUE(robot.extend_map(located_));
    return *point;
  }
  static SE3 ahead(double t) { return SE3::from_xyz_rpy((Vector6() << -3 + 0.3 * t, 0, 1.5, 0, 0, 0).finished()); }

  /// A flight of a second, and a robot that goes on with what a file kept of it.
  Robot restarted() {
    for (int i = 0; i < 10; ++i) last_ = look(before_, ahead(0.1 * i), 1 + 0.1 * i);
    const auto kept = app::decode_keyframes(app::encode({0, keyframes_}));
    EXPECT_TRUE(kept);
    keyframes_ = kept->keyframes;
    return {flying(), one_, another_, monitor_,
            Resume{.map = before_.map(),
                   .map_stamp = last_.stamp,
                   .scans = {},
                   .T_odom_base = last_.T_odom_base,
                   .twist = last_.twist,
                   .stamp = last_.stamp,
                   .keyframes = keyframes_}};
  }

  support::World world_ = support::furnished_room();
  support::StereoView view_{world_, support::small_eyes(), 5};
  stereo::StereoPair pair_;
  LocatedScan located_;
  std::vector<visual_odometry::Keyframe> keyframes_;
  Workers one_{1}, another_{1};
  Monitor monitor_;
  Robot before_{flying(), one_, another_, monitor_};
  TrackPoint last_;
};

TEST_F(StereoResume, GoesOnInItsMapWhereThePictureShowsTheSavedPlace) {
  Robot robot = restarted();
  const std::size_t known = robot.map().size();
  const TrackPoint point = look(robot, ahead(1.5), 5);
  EXPECT_FALSE(point.lost);
  EXPECT_EQ(point.epoch, 0U);
  const SE3 truth = ahead(0).inverse() * ahead(1.5);
  EXPECT_LT((point.T_odom_base.mean.translation() - truth.translation()).norm(), 0.05);
  EXPECT_EQ(robot.map_epoch(), 0U);
  EXPECT_GE(robot.map().size(), known);
}

TEST_F(StereoResume, BeginsAnewElsewhereSaysSoAndKeepsTheSavedMap) {
  Robot robot = restarted();
  const SE3 elsewhere = SE3::from_xyz_rpy((Vector6() << 0, 0, 1.5, 0, 0, 3).finished());
  TrackPoint point;
  for (int i = 0; i < 30 && point.epoch == 0; ++i) {
    point = look(robot, elsewhere, 5 + 0.1 * i);
    EXPECT_TRUE(point.lost);
  }
  EXPECT_EQ(point.epoch, 1U);
  bool said = false;
  for (const Event& event : monitor_.events()) said = said || event.what.find("begins anew") != std::string::npos;
  EXPECT_TRUE(said);
  point = look(robot, elsewhere, 9);
  ASSERT_EQ(robot.earlier_maps().all().size(), 1U);
  EXPECT_EQ(robot.earlier_maps().all().front().epoch, 0U);
}

}  // namespace
}  // namespace cairn
