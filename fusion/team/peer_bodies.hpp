// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "fusion/peers/exchange.hpp"
#include "fusion/peers/items/bodies.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::team {

/// A peer, and the people whom it follows, in this robot's odom frame, predicted to now with constant velocity.
struct PeerBodies {
  peers::RobotId robot = 0;
  Duration age{};                             ///< since the peer saw them
  peers::Bodies::Robot body;                  ///< of the peer
  std::vector<peers::Bodies::Person> people;  ///< ids are the peer's
};

/// What peers said within the last peers::Bodies::kLife, in the order of robots. Peers whose place is not known are
/// left out: `T_team_odom` has all whose place is. The covariances are those of the peers' tracks, grown with the
/// prediction.
[[nodiscard]] std::vector<PeerBodies> bodies_of_peers(const peers::Exchange& exchange,
                                                      const std::map<peers::RobotId, SE3>& T_team_odom, Time now);

}  // namespace cairn::team
