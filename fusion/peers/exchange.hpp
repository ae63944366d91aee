// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/exchange_config.hpp"
#include "fusion/peers/layer_store.hpp"
#include "fusion/peers/link_table.hpp"
#include "fusion/peers/missing_items.hpp"
#include "fusion/peers/sender.hpp"
#include "fusion/peers/status_messages.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::peers {

/// A robot's side of the exchange with its peers: what it publishes itself, what it knows of others, and
/// what is to be sent to whom.
///
/// State travels, not increments. Each robot tells what it knows (Digest). A peer that knows more sends the
/// newest whole state of what is missing, also of third robots if two do not hear each other. So any
/// datagram may be lost. It has no clock and no socket: the same calls give the same bytes.
class Exchange {
 public:
  Exchange(RobotId self, std::string name, Epoch epoch, const ExchangeConfig& config = {});

  /// The robot publishes an item. False if the same was published last.
  bool say(ItemId id, std::span<const std::byte> payload);
  /// The robot begins anew: what it has published is void. `epoch` is higher than the last.
  void begin(Epoch epoch);

  /// Takes in a datagram. After an error nothing was taken from it, but for kLimit of a robot's items:
  /// - kTruncated, kMalformed, kUnsupported: it cannot be read. A peer that sends ten of these in a minute is
  ///   not listened to for a while (see Conduct).
  /// - kLinkDown: the peer is not listened to.
  /// - kLimit: there are more robots, or more of one robot's items, than are kept.
  Result<void> receive(std::span<const std::byte> datagram, Time now);
  /// Appends what is to be sent now. To be called some ten times a second.
  void send(Time now, std::vector<Outgoing>& out);

  /// What peers can use first. Without it, the oldest items are sent first.
  void set_interest(InterestOf interest_of) { interest_of_ = std::move(interest_of); }
  /// Where this robot is, to be told to others.
  void set_place(const Hello::Place& place) { self_.place = place; }

  /// Where this robot is and people are around it, at `seen` of this robot's clock; told to those who hear it. The
  /// epoch and times of `bodies` are filled in here.
  void set_bodies(Bodies bodies, Time seen);

  [[nodiscard]] RobotId self() const { return self_.id; }
  /// The last one begun, or a later one. A later one begins by itself if a peer holds something of this
  /// robot that it has not published in its epoch. All that it has published is published again then.
  [[nodiscard]] Epoch epoch() const { return layers_.own().epoch; }
  /// What all robots publish, this one too.
  [[nodiscard]] const Layers& layers() const { return layers_.all(); }
  [[nodiscard]] const Links& links() const { return links_.all(); }
  [[nodiscard]] bool hears(RobotId robot, Time now) const { return links_.hears(robot, now); }
  /// Whether the peer's map has the same voxels, so that it can be a part of this robot's.
  [[nodiscard]] bool alike(const Link& link) const {
    return config_.voxel_um == 0 || link.voxel_um == config_.voxel_um;
  }
  /// What changed since the last call.
  [[nodiscard]] Changes take_changes() { return layers_.take_changes(); }

 private:
  Result<void> take(RobotId sender, Link& link, const Datagram& datagram, Time now);
  void take(Link& link, const Digest& digest, Time now);
  Result<void> take(Link& link, const Items& items);
  void outdo(Epoch epoch);

  ExchangeConfig config_;
  Identity self_;
  LayerStore layers_;
  LinkTable links_;
  Sender sender_;
  InterestOf interest_of_;
};

}  // namespace cairn::peers
