// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "onboard/mapping/tree/semantic_octree.hpp"
#include "tools/team/figures/robot_result.hpp"

namespace cairn::team {

struct RobotFigures {
  std::string name, team_sha256;
  std::vector<std::string> merged_with;
  /// Of the robots in merged_with, in its order: by how much it is wrong where they are, as this robot sees them at the
  /// end. None without truth.
  std::vector<std::optional<double>> pose_error_m, pose_error_deg;
  std::optional<double> iou_world;  ///< of its team's map
  std::uint64_t ticks = 0, missed_ticks = 0;
};

struct TeamFigures {
  std::vector<RobotFigures> robots;
  std::optional<std::size_t>
      wrong_merges;                 ///< pairs that are in one team though not where they think; none without truth
  std::optional<double> iou_world;  ///< of the largest team's map; of equally large ones the first robot's
  /// Pairs that claim to be merged, or one of whom does, but whose team maps differ.
  std::vector<std::string> disagreements;

  [[nodiscard]] bool sound() const { return disagreements.empty() && wrong_merges.value_or(0) == 0; }
};

/// What a team of robots has come to. `world` is the true map, or null. Pure.
[[nodiscard]] TeamFigures compare_team(const std::vector<RobotResult>& robots, const SemanticOcTree* world);

/// The robot whose team is the largest, the first of them.
[[nodiscard]] std::size_t in_largest_team(const std::vector<RobotResult>& robots);

}  // namespace cairn::team
