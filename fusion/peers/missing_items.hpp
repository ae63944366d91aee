// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "fusion/peers/interest.hpp"
#include "fusion/peers/items/holding.hpp"
#include "fusion/peers/layer_store.hpp"
#include "fusion/peers/link.hpp"

namespace cairn::peers {

/// What `peer` can use first of what `robot` publishes.
using InterestOf = std::function<Interest(RobotId peer, RobotId robot)>;

/// The most urgent tiles are found among so many items that the peer lacks, the oldest ones, and near the peer. What is
/// no tile is always among the most urgent.
inline constexpr std::size_t kLookedAt = 1024;

/// A robot's layer, and the peer that it is to be sent to.
struct Delivery {
  RobotId peer = 0, robot = 0;
  const Layer& layer;
};

/// What the peer lacks of the robot's items and was not sent lately, the most urgent first. Without
/// `interest_of`, the oldest is the most urgent. Nothing if the peer knows a later epoch of the robot, or
/// hears the robot itself; `self` is the robot that sends.
[[nodiscard]] Missing missing_items(const Delivery& delivery, const Link& link, RobotId self,
                                    const InterestOf& interest_of);

}  // namespace cairn::peers
