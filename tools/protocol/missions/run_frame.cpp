// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/missions/run_frame.hpp"

#include <algorithm>

#include "drivers/recording/formats/trajectory_file.hpp"

namespace cairn::protocol {

Result<RunFrame> run_frame(const std::filesystem::path& run, const std::filesystem::path& recording) {
  const auto poses = recording::read_tum(run / "trajectory.tum");
  if (!poses) return poses.error();
  const auto truth = recording::read_tum(recording / "ground_truth.tum");
  if (!truth) return truth.error();
  if (poses->empty() || truth->empty()) return Error{Errc::kMalformed, "no pose", run.string(), {}, {}};
  const Time start = poses->front().stamp;
  const auto at = std::ranges::lower_bound(*truth, start, {}, &recording::StampedPose::stamp);
  if (at == truth->end()) return Error{Errc::kMalformed, "the truth ends before the run", run.string(), {}, {}};
  const double seconds = to_seconds(poses->back().stamp - truth->front().stamp);
  return RunFrame{at->pose * poses->front().pose.inverse(), seconds,
                  seconds / to_seconds(truth->back().stamp - truth->front().stamp)};
}

}  // namespace cairn::protocol
