// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "onboard/mapping/tree/semantic_octree.hpp"
#include "tools/team/figures/robot_result.hpp"

namespace cairn::team_run {

struct RobotFigures {
  std::string name, team_sha256;
  std::vector<std::string> merged_with;
  /// For each robot in merged_with: the error of where this robot sees it at the end. Nothing without truth.
  std::vector<std::optional<double>> pose_error_m, pose_error_deg;
  std::optional<double> iou_world;  ///< of its team's map
  std::uint64_t ticks = 0, missed_ticks = 0;
  std::map<std::string, std::string> not_merged;  ///< all others that it heard of: why not, as the robot says
};

struct TeamFigures {
  std::vector<RobotFigures> robots;
  /// Pairs whose merge is wrong (see is_wrong_merge()); nothing without truth.
  std::optional<std::size_t> wrong_merges;
  std::optional<double> iou_world;  ///< of the largest team's map; of equally large ones, the first robot's
  /// Pairs of which at least one robot counts as merged with the other, but whose team maps differ.
  std::vector<std::string> disagreements;
  /// For each of them why, as far as the robots' counts of tiles show it, and what to do.
  std::vector<std::string> disagreement_hints;

  [[nodiscard]] bool sound() const { return disagreements.empty() && wrong_merges.value_or(0) == 0; }
};

/// Compares what the robots of a team left. `world` is the true map, or null. Pure.
[[nodiscard]] TeamFigures compare_team(const std::vector<RobotResult>& robots, const mapping::SemanticOcTree* world);

/// The index of the robot whose team is the largest; the first of several.
[[nodiscard]] std::size_t in_largest_team(const std::vector<RobotResult>& robots);

}  // namespace cairn::team_run
