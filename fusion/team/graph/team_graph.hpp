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

namespace cairn {

/// Where the robots of a team lie, by what can be true of all claims together.
struct TeamPoses {
  peers::RobotId anchor = 0;                  ///< the lowest id of the team; its submap 0 is the team's frame
  std::map<peers::RobotId, SE3> T_team_odom;  ///< of those connected with the robot that was asked for, itself
                                              ///< included: where their odom frames lie by now, by their newest submaps
  merging::SubmapPoses submaps;               ///< where their odom frames lie as far as a submap's tiles go
  std::vector<bool> kept;                     ///< of the claims, also those about other teams

  PoseGraph graph;  ///< of the submaps themselves
  SubmapNodes nodes;
  /// Where a submap lies in another; nothing where one of them is not in the team.
  [[nodiscard]] std::optional<UncertainPose> between(const merging::SubmapKey& a, const merging::SubmapKey& b) const;
};

/// The poses of the robots that are connected with `self` by claims that agree with each other (see
/// matching::agreement_of(), where odometry leads from a robot's submap to its first), as the least squares of these
/// claims, of refined ones that agree with them, and of odometry from submap to submap. The same claims, in any order,
/// give the same poses, whoever asks; they are rounded so that machines that round differently agree: to 2⁻¹² m and
/// 2⁻¹⁶ rad, or, where robots have several submaps, to 2⁻⁵ m and 2⁻¹² rad (2⁻¹⁰ rad of drift, at the submap), so that
/// what changes little changes nothing. What nobody says has drifted is not moved. Claims about submaps that are not in
/// the chains are not kept, nor refined ones that agreeing_refinements() leaves out.
[[nodiscard]] TeamPoses team_poses(peers::RobotId self, std::span<const PairClaim> claims,
                                   const SubmapChains& chains = {});

}  // namespace cairn
