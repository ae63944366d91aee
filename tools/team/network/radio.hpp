// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hal/time.hpp"
#include "tools/team/network/link_config.hpp"

namespace cairn::team_run {

/// Counts the robots of a run from 0, in the order of their recordings.
using Index = std::size_t;

/// What happens to a packet after its sender's radio has sent it.
struct Fate {
  bool lost = false, twice = false;
  std::array<Duration, 2> delay{};  ///< of the packet, and of its copy
};
/// The fate of the nth packet from one robot to another. Pure: it depends on no other packet.
[[nodiscard]] Fate fate_of(const LinkConfig& link, Index from, Index to, std::uint64_t n);

/// The radio link between all robots. A packet first waits for the sender's rate, in a queue of bounded length: a full
/// queue drops it. Then it has its fate. Pure: the same packets at the same times arrive at the same times.
class Radio {
 public:
  struct Packet {
    Index from = 0, to = 0;
    std::vector<std::byte> bytes;
  };
  /// What one robot sent to others, and what reached it.
  struct Counters {
    std::uint64_t tx_packets = 0, tx_bytes = 0;  ///< offered by the robot, also those that were lost
    std::uint64_t queue_full = 0, lost = 0, doubled = 0;
    std::uint64_t rx_packets = 0, rx_bytes = 0;
  };

  Radio(const LinkConfig& link, Index robots) : link_(link), senders_(robots) {}

  void offer(Index from, Index to, std::span<const std::byte> bytes, Time now);
  /// When the next packet arrives; nothing while no packet is on its way.
  [[nodiscard]] std::optional<Time> next() const;
  /// Appends what has arrived until `now`, in order of arrival.
  void arrived(Time now, std::vector<Packet>& out);

  [[nodiscard]] const Counters& counters(Index robot) const { return senders_[robot].counters; }
  [[nodiscard]] const LinkConfig& link() const { return link_; }
  /// The longest time that a packet was handed out after it was due.
  [[nodiscard]] Duration most_late() const { return most_late_; }

 private:
  struct Sender {
    Time free{Time::min()};                  // when all that it has taken so far is sent
    std::map<Index, std::uint64_t> packets;  // so far, to whom
    Counters counters;
  };

  LinkConfig link_;
  std::vector<Sender> senders_;
  std::multimap<Time, Packet> on_the_way_;  // equal times keep their order
  Duration most_late_{};
};

}  // namespace cairn::team_run
