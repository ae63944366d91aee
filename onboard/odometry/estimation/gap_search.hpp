// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "onboard/odometry/estimation/motion_filter.hpp"

namespace cairn::odometry {

/// Start hypothesis after a gap of `dt` seconds between scans. The prediction may be farther off
/// than registration reaches then: a turn that ended in the gap puts far walls metres away. Looks
/// along one direction after the other (heading, forward, sideways, heading again) for the state
/// with the best score, within three standard deviations of the prediction.
///
/// `score`: how well a state fits, larger is better; called at most 279 times. Ties go to the
/// smallest change.
[[nodiscard]] MotionState search_after_gap(const MotionState& predicted, const Matrix12& covariance, double dt,
                                           const std::function<double(const MotionState&)>& score);

}  // namespace cairn::odometry
