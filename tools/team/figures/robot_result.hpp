// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "tools/team/figures/map_overlap.hpp"

namespace cairn::team_run {

/// What a robot's run left about its part in the team, and the truth if its recording has it.
struct RobotResult {
  std::string name;
  std::string team_sha256;
  std::string anchor;                          ///< the robot whose odom, as it began, is the team's frame
  SE3 T_team_odom;                             ///< this robot's odom in it
  std::vector<std::string> merged_with;        ///< in the order of the team
  std::map<std::string, SE3> T_map_peer;       ///< of peers whose pose is accepted
  std::map<std::string, std::string> reasons;  ///< by peer: why it is merged or not
  std::uint64_t ticks = 0, missed_ticks = 0;
  std::optional<std::uint64_t> own_tiles;              ///< that it said; none: the report does not say it
  std::map<std::string, std::uint64_t> tiles_of_peer;  ///< by peer: how many of its tiles this one holds
  std::vector<recording::StampedPose> trajectory;      ///< T_odom_base
  std::optional<Standing> standing;                    ///< at the end; nothing without truth
  std::shared_ptr<const mapping::SemanticOcTree> team_map;
};

/// Reads report.json, trajectory.tum and team.cairn of the run in `out`, and ground_truth.tum of `recorded` if it is
/// there. `names` are the team's, robot 1 first. A ground truth that has no time in common with the run is ignored.
/// Errors: of files that are missing or malformed.
Result<RobotResult> read_robot_result(const std::filesystem::path& out, const std::filesystem::path& recorded,
                                      const std::vector<std::string>& names);

}  // namespace cairn::team_run
