// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>

#include "fusion/peers/link.hpp"
#include "hal/time.hpp"

namespace cairn::peers {

using Links = std::map<RobotId, Link>;

/// The peers that a robot hears, or has heard.
class LinkTable {
 public:
  /// `lease`: a peer that was not heard for so long is lost.
  LinkTable(std::size_t max_robots, Duration lease) : max_robots_(max_robots), lease_(lease) {}

  /// The link to a peer, which begins if there is none. Null if that were one peer too many.
  [[nodiscard]] Link* open(RobotId peer);
  [[nodiscard]] bool hears(RobotId peer, Time now) const;
  /// There is news of a robot: all peers are to be told.
  void owe(RobotId robot);
  /// What was sent of a robot is void.
  void forget_in_flight(RobotId robot);

  [[nodiscard]] const Links& all() const { return links_; }
  [[nodiscard]] Links& all() { return links_; }

 private:
  std::size_t max_robots_;
  Duration lease_;
  Links links_;
};

}  // namespace cairn::peers
