// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/accuracy.hpp"

namespace cairn::report {

Accuracy accuracy_of(const RunReport& report) {
  if (report.ground_truth.empty()) return {};
  std::vector<StampedPose> means;
  for (const PoseEstimate& p : report.trajectory) means.push_back({p.stamp, p.T_odom_base.mean});
  const TrajectoryErrorOptions options;
  const auto error = trajectory_error(means, report.ground_truth, options);
  if (!error) return {.error = {}, .why_not = to_string(error.error()), .pose_errors = {}};
  return {.error = *error,
          .why_not = {},
          .pose_errors = pose_errors(report.trajectory, report.ground_truth, options.max_gap)};
}

}  // namespace cairn::report
