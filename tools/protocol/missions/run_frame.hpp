// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::protocol {

/// A run of a simulated recording, or of its beginning, against the truth.
struct RunFrame {
  SE3 T_world_odom;    ///< true at the run's first pose
  double seconds = 0;  ///< from the recording's first true pose to the run's last one
  double share = 0;    ///< of the whole recording
};
/// `run`: a folder that `cairn run` left, with trajectory.tum. `recording`: with ground_truth.tum. Errors: those of the
/// files; kMalformed without poses.
[[nodiscard]] Result<RunFrame> run_frame(const std::filesystem::path& run, const std::filesystem::path& recording);

}  // namespace cairn::protocol
