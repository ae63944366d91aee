// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "onboard/odometry/estimation/motion_filter.hpp"

namespace cairn {

/// After some seconds without scans the prediction may be farther off than registration reaches: a turn that ended in
/// the gap puts far walls metres away. Looks along one direction after the other (heading, forward, sideways, heading
/// again) for the state that most points agree with, within three standard deviations of the prediction.
///
/// `score`: how well a state fits, larger is better; called at most about 200 times. Ties go to the smallest change.
[[nodiscard]] MotionState search_after_gap(const MotionState& predicted, const Matrix12& covariance, double dt,
                                           const std::function<double(const MotionState&)>& score);

}  // namespace cairn
