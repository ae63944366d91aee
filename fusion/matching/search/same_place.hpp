// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"

namespace cairn::matching {

/// Two poses less than this apart are one place that was found twice: 0.8 m and 4°. The coarse
/// search, the sweep over all headings, the ranking of results and the hypotheses all use this
/// rule. 0.8 m is two cells of the coarse search. From a prototype on 13 pairs of maps with 125
/// starts each.
inline constexpr double kSamePlace_m = 0.8, kSamePlace_rad = 0.07;

/// The rule for a distance (m) and an angle (rad, not negative) between two poses.
[[nodiscard]] constexpr bool same_place(double apart_m, double apart_rad) {
  return apart_m < kSamePlace_m && apart_rad < kSamePlace_rad;
}
/// The rule for two poses of one map in another.
[[nodiscard]] inline bool same_place(const SE3& T, const SE3& other) {
  const SE3 between = T.inverse() * other;
  return same_place(between.translation().norm(), rotation_angle(between));
}

}  // namespace cairn::matching
