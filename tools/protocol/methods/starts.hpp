// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hal/se3.hpp"

namespace cairn::protocol {

/// One start of the book's protocol (section 4.6.3): its offset from the true pose.
struct Start {
  double x_m = 0, y_m = 0, yaw_deg = 0;

  [[nodiscard]] double distance_m() const;
};

/// All 125: x and y from −2 to 2 m by 1 m, yaw from −15° to 15° by 7.5°; x slowest.
[[nodiscard]] const std::vector<Start>& starts();
inline constexpr int kStarts = 125, kExactStart = 62;
/// Numbers of `count` of the starts, spread over all of them: the exact start first; among the
/// first 5 each x, y and yaw comes once, among the first 25 each pair of two of them.
[[nodiscard]] std::vector<int> chosen_starts(int count);

/// The start pose: the truth, turned about b's own z axis, then moved in frame a.
[[nodiscard]] SE3 start_pose(const SE3& T_a_b, const Start& start);

/// Distance and angle between an estimate and the truth.
struct PoseError {
  double m = 0, deg = 0;

  /// The book's criterion: at most 0.6 m and 6°.
  [[nodiscard]] bool success() const { return m <= 0.6 && deg <= 6; }
};
/// The error of an estimate is T_est⁻¹·T_true: how far off b's own origin lies. The book takes
/// T_est·T_true⁻¹, whose translation grows with the distance of b from a's origin.
[[nodiscard]] PoseError error_of(const SE3& estimate, const SE3& truth);

}  // namespace cairn::protocol
