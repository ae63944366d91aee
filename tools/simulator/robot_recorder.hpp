// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/workers.hpp"
#include "tools/simulator/stage.hpp"

namespace cairn::simulator {

/// Writes the recording and the ground truth of robot number `robot` into `dir`; see simulate(). What is there after an
/// error is the caller's to remove.
Result<RobotSummary> record_robot(const SimulationConfig& config, const Stage& stage, std::size_t robot,
                                  Workers& workers, const std::filesystem::path& dir, const Progress& progress);

}  // namespace cairn::simulator
