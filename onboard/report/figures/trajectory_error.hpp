// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::report {

using recording::StampedPose;

/// How the estimate is laid over the ground truth before absolute errors are taken.
enum class Alignment {
  kFirst,  ///< the first matched poses coincide, position and heading: shows drift as the robot lives it
  kSe3,    ///< least squares over all matched positions without scale (Umeyama 1991): evo's `-a`, the usual ATE
  kNone,   ///< both are in the same frame already
};
[[nodiscard]] std::optional<Alignment> alignment_from(std::string_view name);
[[nodiscard]] std::string_view to_string(Alignment alignment);

/// Good odometry drifts by less than half a percent of the distance. An error above this share of it is large.
inline constexpr double kLargeError_percent = 2;

/// How a trajectory is compared with the ground truth.
struct TrajectoryErrorOptions {
  Alignment alignment = Alignment::kSe3;
  /// The ground truth is interpolated (position linearly, rotation along the shortest arc) between two neighbours that
  /// are no further apart than this. The position is off by at most a·gap²/8: 5 mm at 1 m/s² and 0.2 s.
  Duration max_gap = from_seconds(0.2);
};

/// One moment for which both are known.
struct MatchedPose {
  Time stamp{};
  SE3 truth;     ///< in the ground truth's frame
  SE3 estimate;  ///< in the estimate's frame
};

/// The estimate's poses that have a ground truth, in order of time. Both inputs are ordered by time.
[[nodiscard]] std::vector<MatchedPose> match_by_time(std::span<const StampedPose> estimate,
                                                     std::span<const StampedPose> truth, Duration max_gap);

/// The T_truth_estimate that lays the estimate over the ground truth; `matched` is not empty.
/// What least squares leaves open (the roll about a straight line, any rotation of a robot that stood still) is taken
/// from the first poses.
[[nodiscard]] SE3 align(std::span<const MatchedPose> matched, Alignment alignment);

/// The ground truth as the robot would have drawn it: moved into the estimate's frame by the first common pose.
/// Unchanged where there is none.
[[nodiscard]] std::vector<StampedPose> truth_in_estimate_frame(std::span<const StampedPose> estimate,
                                                               std::span<const StampedPose> truth, Duration max_gap);

/// Relative errors over a set of segments.
struct RelativeError {
  std::size_t segments = 0;
  double trans_percent = 0;  ///< translation error / driven length
  double rot_deg_per_m = 0;  ///< rotation error / driven length
};

/// Figures of `cairn evaluate trajectory`; lengths are those of the ground truth over the matched poses.
struct TrajectoryError {
  std::size_t matched = 0;
  std::size_t unmatched = 0;  ///< estimated poses without ground truth around them
  double length_m = 0;
  double duration_s = 0;
  double ate_rmse_m = 0;  ///< RMS position error after the chosen alignment
  double ate_max_m = 0;
  double ate_first_rmse_m = 0;  ///< the same, first poses laid over each other
  double ate_se3_rmse_m = 0;    ///< the same, least squares
  double final_error_m = 0;     ///< at the last matched pose, first poses laid over each other (kNone: as they are)
  std::optional<double> final_error_percent;  ///< of length_m; none for a robot that stood still
  /// KITTI's relative errors (Geiger et al. 2012): mean over all segments of eight lengths from every pose. KITTI takes
  /// 100 … 800 m; runs below 1 km take 10 % … 80 % of their own length instead. Errors are divided by the length that
  /// was really driven in the segment, so that sparse poses do not inflate them.
  std::optional<RelativeError> segments;
  /// The same from each pose to the next, total error over total length: for sequences of a few scans.
  std::optional<RelativeError> steps;
};

/// Error: fewer than two poses match.
[[nodiscard]] Result<TrajectoryError> trajectory_error(std::span<const StampedPose> estimate,
                                                       std::span<const StampedPose> truth,
                                                       const TrajectoryErrorOptions& options);

}  // namespace cairn::report
