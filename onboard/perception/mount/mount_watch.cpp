// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/mount/mount_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::mount {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kUsualDepth_m = 5;  // of what is seen: where a corner is looked for first

EstimatorConfig estimator_of(const cameras::CameraModel& camera, Duration window) {
  constexpr double kCorner_px = 0.2;
  return {.sight_rad = kCorner_px / camera.parameters().fx, .window = window};
}

}  // namespace

void declare(config::Section& s, MountConfig& c) {
  s.number("rate_hz", c.rate_hz, {0, 60}, "Hz",
           "pictures that are compared with the robot's motion, to see whether a camera was moved; 0: not watched");
  s.number("moved_deg", c.moved_deg, {0.2, 10}, "deg", "a camera that is turned by more about an axis was moved");
}

MountWatch::MountWatch(const cameras::CameraModel& camera, const SE3& T_base_camera, const MountConfig& config,
                       Duration window)
    : camera_(camera),
      T_base_optical_(T_base_camera * cameras::T_camera_optical()),
      moved_rad_(config.moved_deg * kDegree),
      estimator_(T_base_camera, estimator_of(camera, window)) {}

bool MountWatch::look(const Image& picture, const SE3& T_odom_base, std::uint32_t epoch) {
  if (picture.width != camera_.width() || picture.height != camera_.height()) return false;
  const bool usable = reference_ && reference_->epoch == epoch && picture.stamp > reference_->stamp &&
                      picture.stamp - reference_->stamp <= kOldest;
  if (usable) {
    const SE3 T_before_now = reference_->T_odom_base.inverse() * T_odom_base;
    if (T_before_now.translation().norm() < kLeastWay_m && rotation_angle(T_before_now) < kLeastTurn_rad) return true;
    compare(picture, T_before_now);
    tracker_.refer_to_found();
  } else {
    tracker_.refer_to(picture);
  }
  reference_ = {picture.stamp, T_odom_base, epoch};
  return true;
}

void MountWatch::compare(const Image& picture, const SE3& T_before_now) {
  const SE3 T_now_before = (T_before_now * T_base_optical_).inverse() * T_base_optical_;
  const auto matches = tracker_.find_in(picture, [&](const Eigen::Vector2d& before) -> std::optional<Eigen::Vector2d> {
    const auto ray = camera_.unproject(before);
    if (!ray) return {};
    return camera_.project(T_now_before * (*ray * kUsualDepth_m));
  });
  const Eigen::Matrix3d R = cameras::T_camera_optical().rotation();
  sightings_.clear();
  for (const Match& match : matches) {
    const auto before = camera_.unproject(match.before), now = camera_.unproject(match.now);
    if (before && now) sightings_.push_back({R * *before, R * *now});
  }
  estimator_.add(picture.stamp, T_before_now, sightings_);
  ++pairs_;
  estimate_ = estimator_.estimate();
  confirmed_ = turned() ? confirmed_ + 1 : 0;
  moved_ = moved_ || confirmed_ >= kConfirm;
}

bool MountWatch::turned() const {
  if (!estimate_) return false;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double turn = std::abs(estimate_->turn_rad[axis]), deviation = estimate_->deviation_rad(axis);
    if (deviation <= kSure_deg * kDegree && turn > moved_rad_ && turn > kDeviations * deviation) return true;
  }
  return false;
}

}  // namespace cairn::mount
