// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "fusion/peers/item.hpp"
#include "hal/se3.hpp"

namespace cairn {

/// Somebody's finding where robot b's odom frame lies in robot a's.
struct PairClaim {
  peers::RobotId a = 0, b = 0;
  UncertainPose T_a_b;
  double probability = 0;  ///< that it is right, taken by itself
};

/// Where the robots of a team lie, by what can be true of all claims together.
struct TeamPoses {
  peers::RobotId anchor = 0;                  ///< the lowest id of the team; its odom frame is the team's
  std::map<peers::RobotId, SE3> T_team_odom;  ///< of those connected with the robot that was asked for, itself included
  std::vector<bool> kept;                     ///< of the claims, also those about other teams
};

/// The poses of the robots that are connected with `self` by claims that agree with each other (see
/// matching::agreement_of()), as the least squares of these claims weighted by their covariances: a pose graph, its
/// anchor fixed. The same claims, in any order, give the same poses, whoever asks; they are rounded (2⁻¹² m, 2⁻¹⁶ rad)
/// so that machines that round differently agree.
[[nodiscard]] TeamPoses team_poses(peers::RobotId self, std::span<const PairClaim> claims);

}  // namespace cairn
