// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "onboard/report/figures/run_report.hpp"

namespace cairn::report {

/// Error of one estimate, with what the estimate itself claims about it.
struct PoseError {
  Time stamp{};
  Vector6 error = Vector6::Zero();  ///< log(T_estimate⁻¹·T_truth): metres and radians along base_link's axes
  Vector6 sigma = Vector6::Zero();  ///< standard deviations from the claimed covariance; zero: nothing claimed
  double distance_m = 0;            ///< between both positions
};

/// The first poses are laid over each other, because that is where the claimed covariance begins to grow.
/// Empty where there is no common time.
[[nodiscard]] std::vector<PoseError> pose_errors(std::span<const PoseEstimate> trajectory,
                                                 std::span<const StampedPose> truth, Duration max_gap);

/// Share (0…1) of the errors within 3 σ per axis; none where no covariance was claimed.
[[nodiscard]] std::array<std::optional<double>, 6> share_inside_3_sigma(std::span<const PoseError> errors);

}  // namespace cairn::report
