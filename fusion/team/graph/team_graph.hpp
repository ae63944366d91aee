// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "fusion/merging/team_map.hpp"
#include "fusion/peers/items/item.hpp"
#include "fusion/team/graph/pair_claim.hpp"
#include "fusion/team/graph/pose_graph.hpp"
#include "fusion/team/graph/refined_claims.hpp"
#include "hal/se3.hpp"

namespace cairn::team {

/// Where the robots of a team lie, by what can be true of all claims together. T_team_odom has the robot
/// that was asked for, and all robots that are connected with it.
struct TeamPoses {
  peers::RobotId anchor = 0;                  ///< the lowest id of the team; its submap 0 is the team's frame
  std::map<peers::RobotId, SE3> T_team_odom;  ///< by now: as far as the tiles of the newest submaps go
  merging::SubmapPoses submaps;               ///< T_team_odom as far as the tiles of each submap go
  std::vector<bool> kept;                     ///< for each claim: agrees with the others; other teams' too

  PoseGraph graph;  ///< of the submaps themselves
  SubmapNodes nodes;

  /// Where one submap lies in another; nothing if one of them is not in the team.
  [[nodiscard]] std::optional<UncertainPose> between(const merging::SubmapKey& a, const merging::SubmapKey& b) const;
  /// Where b's odom frame lies in a's by now; nothing if one of them is not in the team.
  [[nodiscard]] std::optional<SE3> odom_between(peers::RobotId a, peers::RobotId b) const;
  /// Where a robot's odom frame lies, as far as each submap's tiles go, in the odom frame of its submap 0.
  /// Submaps that have not drifted against submap 0 are left out.
  [[nodiscard]] std::map<std::uint16_t, SE3> drifts_of(peers::RobotId robot) const;
};

/// The poses of the robots that are connected with `self` by claims that agree with each other (see
/// matching::agreement_of(); odometry leads from a robot's submap to its first). They are the least squares
/// of these claims, of refined claims that agree with them, and of odometry from submap to submap.
///
/// The same claims, in any order, give the same poses to every robot. Poses are rounded, so that machines
/// that round differently agree, and a small change of the claims changes nothing:
/// - to 2⁻¹² m and 2⁻¹⁶ rad, if every robot has one submap;
/// - else to 2⁻⁵ m and 2⁻¹² rad, and drift to 2⁻⁵ m and 2⁻¹⁰ rad at the submap.
/// A submap is not moved if no claim says that it has drifted. These claims are not kept: those about submaps
/// that are not in the chains, and refined ones that agreeing_refinements() leaves out.
[[nodiscard]] TeamPoses team_poses(peers::RobotId self, std::span<const PairClaim> claims,
                                   const SubmapChains& chains = {});

}  // namespace cairn::team
