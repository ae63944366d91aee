// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/twist_check.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

struct Limits {
  double share;  // per scan
  double m_s, rad_s;
};

// Over about three scans. Jerks and bumps differ for one scan, and once to each side. Drives of 3 m/s and 120°/s, with
// onsets of 0.1 s, stay below. A map that was begun in a turn with a wrong twist differs by 1 to 2 rad/s.
constexpr Limits kFast{.share = 0.3, .m_s = 1.0, .rad_s = 0.5};
// Over about twenty scans. Rides that go well reach 0.08 m/s and 0.035 rad/s, also aggressive and hand-held ones. A
// twist that a map confirms differs by more from the start on, and grows (0.09 rad/s within 5 s, 4 m/s after 13 s).
constexpr Limits kSlow{.share = 0.05, .m_s = 0.2, .rad_s = 0.07};
// Of the slow limits: so little may be lacking before nothing is added any more.
constexpr double kMended = 0.25;
// Scans, and times the slow limits. Below, a map is worth more than a new one, which begins with a single scan: drives
// through simulated forests ended 0.4 m off with a new one, 0.15 m without.
constexpr int kPatience = 20;
constexpr double kTooWrong = 2.5;
// s. What a robot did in a longer time is not steady.
constexpr double kSteady_s = 0.25;
constexpr int kYaw = 5;

/// As a share of the limits.
double excess(const Vector6& difference, const Limits& limits) {
  return std::max(difference.head<3>().norm() / limits.m_s, std::abs(difference[kYaw]) / limits.rad_s);
}

}  // namespace

void TwistCheck::note(const SE3& motion, double dt_s, const Vector6& before, const Vector6& after) {
  const Vector6 difference = motion.log() / dt_s - 0.5 * (before - added_ + after);
  fast_ += kFast.share * (difference - fast_);
  if (dt_s > kSteady_s) return;
  slow_ += kSlow.share * (difference - slow_);
  slow_weight_ += kSlow.share * (1 - slow_weight_);
}

bool TwistCheck::contradicted() const { return excess(fast_, kFast) > 1; }

Vector6 TwistCheck::lacking() {
  const double limit = added_.isZero() ? 1 : kMended;
  added_ = excess(slow_, kSlow) > limit ? Vector6(slow_ / slow_weight_) : Vector6::Zero();
  mended_scans_ = added_.isZero() ? 0 : mended_scans_ + 1;
  return added_;
}

bool TwistCheck::map_confirms_wrong_twist() const {
  return mended_scans_ > kPatience && excess(slow_, kSlow) > kTooWrong;
}

void TwistCheck::reset() { *this = {}; }

}  // namespace cairn::odometry
