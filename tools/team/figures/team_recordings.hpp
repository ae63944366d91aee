// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::team_run {

/// A robot's recording, read once from end to end.
struct TeamRecording {
  std::string name;              ///< the robot's, its own in the team
  std::filesystem::path folder;  ///< absolute
  Duration length{};             ///< from the first packet to the last
  std::uint64_t raw_bytes = 0;   ///< of all packets, without transport headers
};

/// `folders` are recordings, or folders of recordings as `cairn simulate` makes them, which are taken in the order of
/// their names. Errors: those of the recordings; kInvalidConfig if two robots have one name, or there are fewer than
/// two.
Result<std::vector<TeamRecording>> survey_recordings(const std::vector<std::filesystem::path>& folders);

}  // namespace cairn::team_run
