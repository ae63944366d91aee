// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/interest.hpp"
#include "fusion/peers/items/holding.hpp"
#include "fusion/peers/link.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::peers {

struct ExchangeConfig {
  std::size_t bytes_per_second = 8000;  ///< of all that is sent, overhead included; a second's may gather
  Duration hello_period = std::chrono::seconds(1);
  Duration announcement_period = std::chrono::seconds(10);  ///< to robots never heard of, where others were
  Duration digest_period = std::chrono::seconds(1);         ///< of robots of whom more is known than before
  Duration digest_repeat = std::chrono::seconds(3);         ///< of all
  Duration lease = std::chrono::seconds(3);                 ///< a peer that was not heard for so long is lost
  Duration longest_way = std::chrono::seconds(2);           ///< there and back: what takes longer is taken for lost
  Duration answer = std::chrono::milliseconds(200);         ///< robots take so long to
  Duration gather = std::chrono::milliseconds(300);         ///< items wait so long for others to share a datagram with
  std::size_t overhead_bytes = 100;                         ///< of RTPS, UDP and IP with each datagram
  std::size_t max_bytes_per_robot = Holding::kMaxBytes;
  std::size_t max_robots = 16;  ///< more are not listened to
  std::uint32_t voxel_um = 0;   ///< of what this robot says; where it is not 0, only robots with the same are believed
};

/// What one robot says, as far as it is known here.
struct Layer {
  Epoch epoch = 0;
  Holding holding;
};

/// A datagram to be sent; to everyone where `to` is 0.
struct Outgoing {
  RobotId to = 0;
  std::vector<std::byte> bytes;
};

/// What changed in what is known of a robot.
struct LayerChange {
  bool anew = false;  ///< a new epoch: all earlier items are gone
  std::set<ItemId> items;
};
using Changes = std::map<RobotId, LayerChange>;

/// A robot's side of the exchange: what it says itself, what it knows of others, and what is to be sent to whom. State
/// travels, not increments: each robot tells what it knows (Digest), and whoever knows more sends the newest whole
/// state of what is missing, also of third robots where two do not hear each other. So nothing depends on which
/// datagrams arrive, only on some of them doing so. Pure: no clock, no socket; the same calls give the same bytes.
class Exchange {
 public:
  /// What `peer` can use first of what `robot` says.
  using InterestOf = std::function<Interest(RobotId peer, RobotId robot)>;

  Exchange(RobotId self, std::string name, Epoch epoch, const ExchangeConfig& config = {});

  /// The robot's own news; false where it is none.
  bool say(ItemId id, std::span<const std::byte> payload);
  /// What was said so far is void. `epoch` is higher than the last.
  void begin(Epoch epoch);

  /// Takes in a datagram. An error: nothing was taken from it, and its sender has lost some trust where it could be
  /// told; a peer that sends too many is not listened to for a while (kLinkDown).
  Result<void> receive(std::span<const std::byte> datagram, Time now);
  /// Appends what is to be sent now: what is due of hellos and digests in one, then missing items while the bytes last.
  void send(Time now, std::vector<Outgoing>& out);

  /// Without it, or for whoever it knows nothing of, the oldest is sent first.
  void set_interest(InterestOf interest) { interest_ = std::move(interest); }
  /// Where this robot is, to be told to others.
  void set_place(const Hello::Place& place) { place_ = place; }

  [[nodiscard]] RobotId self() const { return self_; }
  /// The last one begun; or a later one, after a peer turned out to hold something of this robot that it never said:
  /// of a later epoch, or from before it forgot which one it was in. What it has said is said again then.
  [[nodiscard]] Epoch epoch() const { return layers_.at(self_).epoch; }
  /// Everyone's layers, one's own too.
  [[nodiscard]] const std::map<RobotId, Layer>& layers() const { return layers_; }
  [[nodiscard]] const std::map<RobotId, Link>& links() const { return links_; }
  [[nodiscard]] bool hears(RobotId robot, Time now) const;
  /// Whether its map can be a part of this one's.
  [[nodiscard]] bool alike(const Link& link) const {
    return config_.voxel_um == 0 || link.voxel_um == config_.voxel_um;
  }
  /// What changed since the last call.
  [[nodiscard]] Changes take_changes();

 private:
  [[nodiscard]] Duration way_of(const Link& link) const;
  /// Whose items go to whom.
  struct Address {
    RobotId peer, robot;
    const Layer& layer;
  };

  bool take(RobotId sender, Link& link, const Hello& hello, Time now);
  void take(Link& link, const Digest& digest, Time now);
  Result<void> take(Link& link, const Items& items);
  void outdo(Epoch epoch);
  void hear_of(RobotId robot, Epoch epoch);
  Link* link_of(RobotId robot);
  Layer* layer_of(RobotId robot, Epoch epoch);
  void announce(Time now, std::vector<Outgoing>& out);
  void send_status(Time now, RobotId peer, Link& link, std::vector<Outgoing>& out);
  [[nodiscard]] Datagram status(Time now, RobotId peer, const Link& link) const;
  [[nodiscard]] Datagram companion(Time now, RobotId peer, const Link& link) const;
  void note_told(Link& link, Time now, const Datagram& datagram, std::size_t bytes) const;
  [[nodiscard]] Hello hello(Time now, RobotId peer) const;
  [[nodiscard]] Digest digest(Time now, const std::optional<std::set<RobotId>>& robots) const;
  void send_items(Time now, RobotId peer, Link& link, std::vector<Outgoing>& out);
  void send_layer(Time now, const Address& address, Link& link, std::vector<Outgoing>& out);
  [[nodiscard]] Missing missing_at(const Link& link, const Address& address) const;
  void add_near_by(std::vector<ItemUpdate>& updates, const Interest& interest, const Address& address,
                   const VersionSet& at_peer) const;

  RobotId self_;
  std::string name_;
  ExchangeConfig config_;
  InterestOf interest_;
  std::optional<Hello::Place> place_;
  std::map<RobotId, Layer> layers_;
  std::map<RobotId, Link> links_;
  Changes changes_;
  double bytes_ = 0;  // that may be sent
  Time last_send_ = Time::min(), next_announcement_ = Time::min();
  RobotId next_peer_ = 0;  // whose turn it is
};

}  // namespace cairn::peers
