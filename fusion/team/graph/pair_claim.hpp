// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "fusion/peers/items/item.hpp"
#include "hal/se3.hpp"

namespace cairn::team {

/// Somebody's finding where a submap of robot b lies in one of robot a's.
struct PairClaim {
  peers::RobotId a = 0, b = 0;
  UncertainPose T_a_b;
  double probability = 0;  ///< that it is right, taken by itself
  std::uint16_t submap_a = 0, submap_b = 0;
  bool refined = false;  ///< found from where the claims that are not put the two: it connects nobody
};

/// An order of claims that does not depend on who heard of which first: the surest first.
[[nodiscard]] bool before(const PairClaim& x, const PairClaim& y);

/// Where each robot's submaps lie in its odom, from submap 1 on; each covariance is that of the motion since the one
/// before. Submap 0 lies at the origin of odom.
using SubmapChains = std::map<peers::RobotId, std::vector<UncertainPose>>;

/// How many submaps of a robot are known, one at least.
[[nodiscard]] std::size_t submaps_of(const SubmapChains& chains, peers::RobotId robot);
/// A submap's place in its robot's odom. Here and below, the submaps are below submaps_of().
[[nodiscard]] SE3 place_in_odom(const SubmapChains& chains, peers::RobotId robot, std::size_t submap);
/// Where one submap of a robot lies in another, by its odometry alone.
[[nodiscard]] UncertainPose motion(const SubmapChains& chains, peers::RobotId robot, std::size_t from, std::size_t to);

}  // namespace cairn::team
