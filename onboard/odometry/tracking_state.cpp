// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/tracking_state.hpp"

#include <algorithm>

namespace cairn::odometry {
namespace {

// In revolutions. One missing scan puts the next one two revolutions after the last; 1.8 leaves
// room for jitter.
constexpr double kGap = 1.8;
// Of a revolution. A shorter scan after a gap led a turning robot astray (test
// ATurnThatEndsWhileNoScanComesIsFollowed).
constexpr double kWholeScan = 0.6;
// The longest revolution that counts gets shorter by this share of the time that passes. A motor may turn faster from
// now on: one that turns twice as fast is noticed within seven scans.
constexpr double kShorter = 0.1;
// Of the first scan of a map: a second one of 0.72 gave it a wrong motion, and 0.15 m of drift for the whole run (test
// AMapsFirstMotionIsThatOfAWholeRevolution). It is waited for so many revolutions: a motor may turn faster from now on.
constexpr double kAsWhole = 0.9;
constexpr double kWholeComes = 3;
constexpr int kDirections = 6;  // in which a robot moves
// Of min_matches: fewer say nothing, however few directions they are asked about.
constexpr double kFewestShare = 1.0 / 3.0;

}  // namespace

std::string_view to_string(Track track) {
  switch (track) {
    case Track::kFollowed:
      return "followed";
    case Track::kLost:
      return "lost";
    case Track::kReinitialised:
      return "reinitialised";
  }
  return "unknown";
}

TrackingState::TrackingState(const OdometryConfig& config)
    : blind_after_s_(config.second_look.blind_after_s),
      min_matches_(config.min_matches),
      min_inlier_ratio_(config.min_inlier_ratio),
      max_speed_m_s_(config.max_speed),
      max_angular_speed_rad_s_(config.max_angular_speed) {}

void TrackingState::begin(Time stamp) {
  last_stamp_ = followed_stamp_ = stamp;
  lost_in_a_row_ = 0;
  blind_ = false;
}

bool TrackingState::is_fragment_after_gap(double dt_s, double duration_s) const {
  return dt_s > kGap * revolution_s_ && is_fragment(duration_s);
}

bool TrackingState::is_piece_after(double whole_s, Time stamp, double duration_s) const {
  return duration_s < kAsWhole * whole_s && seconds_since_last(stamp) < kWholeComes * whole_s;
}

bool TrackingState::is_fragment(double duration_s) const { return duration_s < kWholeScan * revolution_s_; }

void TrackingState::advance(Time stamp, double duration_s) {
  last_was_fragment_ = is_fragment(duration_s);
  revolution_s_ = std::max(duration_s, revolution_s_ - kShorter * duration_s);
  blind_ = blind_ || seconds_since_last(stamp) > blind_after_s_;
  last_stamp_ = stamp;
}

Track TrackingState::judge(const Fit& fit, const SE3& motion, double dt_s, const PatchMap& map, bool sure,
                           int patience) {
  const bool followed = sure && plausible(fit, motion, dt_s);
  if (!followed && ++lost_in_a_row_ < patience && map.patches() > 0) return Track::kLost;
  lost_in_a_row_ = 0;
  blind_ = false;
  followed_stamp_ = last_stamp_.value_or(followed_stamp_);
  return followed ? Track::kFollowed : Track::kReinitialised;
}

bool TrackingState::fits(const Fit& fit) const {
  const NormalEquations& n = fit.equations;
  const double asked = std::max(kFewestShare, 1.0 - static_cast<double>(fit.degeneracy.count) / kDirections);
  return n.matched >= asked * min_matches_ && n.inliers >= min_inlier_ratio_ * n.matched;
}

bool TrackingState::plausible(const Fit& fit, const SE3& motion, double dt_s) const {
  return fits(fit) && motion.translation().norm() <= max_speed_m_s_ * dt_s &&
         rotation_angle(motion) <= max_angular_speed_rad_s_ * dt_s;
}

}  // namespace cairn::odometry
