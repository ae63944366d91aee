// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/result.hpp"

namespace cairn::protocol {

struct MissionsOptions {
  std::filesystem::path recordings;  ///< recordings/LIGHT/robot_N
  std::filesystem::path runs;        ///< runs/LIGHT/PIPELINE/PHASE/robot_N, as `cairn run` leaves them
  std::filesystem::path out;         ///< gets a folder for each pair of maps, with pair.json and mission.json
};

/// The pairs of maps that both robots' runs have left. The maps are Cairn's own, with the errors of
/// its odometry; where one lies in the other is the truth at the first pose. Errors: those of the
/// files.
[[nodiscard]] Result<void> make_missions(const MissionsOptions& options);

}  // namespace cairn::protocol
