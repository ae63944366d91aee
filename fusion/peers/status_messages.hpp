// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>

#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/exchange_config.hpp"
#include "fusion/peers/layer_store.hpp"
#include "fusion/peers/link_table.hpp"
#include "hal/time.hpp"

namespace cairn::peers {

/// What a robot tells peers of itself.
struct Identity {
  RobotId id = 0;
  std::string name;                     ///< for people
  std::optional<Hello::Place> place{};  ///< where it is, in its odom frame
  std::optional<Bodies> bodies{};       ///< the same, and people around it; `age` is not kept here
};

/// The messages by which a robot tells that it is there (hello), and what it knows of each robot (digest).
/// It writes those of one moment, and refers to what it is given. It changes nothing.
class StatusMessages {
 public:
  StatusMessages(const ExchangeConfig& config, const Identity& self, const LayerStore& layers, const LinkTable& links,
                 Time now)
      : config_(config), self_(self), layers_(layers), links_(links), now_(now) {}

  /// For everyone, also for robots that were never heard of: all that is known.
  [[nodiscard]] Datagram announcement() const;
  /// For one peer: a hello, and a digest if one is due: of all robots, or of those with news.
  [[nodiscard]] Datagram status(RobotId peer, const Link& link) const;
  /// What goes along with items: a status that is due soon, or else a digest of the robots with news. It
  /// has only the sender if that would take much of the items' room.
  [[nodiscard]] Datagram companion(RobotId peer, const Link& link) const;
  /// Where the robot is and people are; none: nothing newer than `told`, or what is known is too old.
  [[nodiscard]] std::optional<Datagram> bodies(Time told) const;
  [[nodiscard]] RobotId sender() const { return self_.id; }

 private:
  [[nodiscard]] Hello hello(RobotId peer) const;
  [[nodiscard]] Digest digest_of_all() const;
  [[nodiscard]] Digest digest_of(const std::set<RobotId>& robots) const;
  void add(Digest& digest, RobotId robot, const Layer& layer) const;

  const ExchangeConfig& config_;
  const Identity& self_;
  const LayerStore& layers_;
  const LinkTable& links_;
  Time now_;
};

}  // namespace cairn::peers
