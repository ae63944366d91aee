// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "onboard/report/figures/pose_error.hpp"
#include "onboard/report/figures/run_report.hpp"

namespace cairn::report {

/// The errors of a run against its ground truth, aligned as TrajectoryErrorOptions does by default.
struct Accuracy {
  std::optional<TrajectoryError> error;  ///< none without ground truth, or where `why_not` says why
  std::string why_not;                   ///< there is a ground truth, but it cannot be compared
  std::vector<PoseError> pose_errors;
};

[[nodiscard]] Accuracy accuracy_of(const RunReport& report);

}  // namespace cairn::report
