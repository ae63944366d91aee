// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/twist_check.hpp"

#include <cmath>

namespace cairn::odometry {
namespace {

// Per scan: over about three scans. Jerks and bumps differ for one scan, and once to each side.
constexpr double kShare = 0.3;
// m/s and rad/s. Drives of 3 m/s and 120°/s, with onsets of 0.1 s, stay below. A map that was begun
// in a turn with a wrong twist differs by 1 to 2 rad/s.
constexpr double kMost_m_s = 1.0, kMost_rad_s = 0.5;
constexpr int kYaw = 5;

}  // namespace

bool TwistCheck::contradicts(const SE3& motion, double dt_s, const Vector6& before, const Vector6& after) {
  difference_ += kShare * (motion.log() / dt_s - 0.5 * (before + after) - difference_);
  return difference_.head<3>().norm() > kMost_m_s || std::abs(difference_[kYaw]) > kMost_rad_s;
}

}  // namespace cairn::odometry
