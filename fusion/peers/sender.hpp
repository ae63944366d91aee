// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/peers/byte_budget.hpp"
#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/exchange_config.hpp"
#include "fusion/peers/layer_store.hpp"
#include "fusion/peers/link_table.hpp"
#include "fusion/peers/missing_items.hpp"
#include "fusion/peers/status_messages.hpp"
#include "hal/time.hpp"

namespace cairn::peers {

/// A datagram to be sent; to everyone if `to` is 0.
struct Outgoing {
  RobotId to = 0;
  std::vector<std::byte> bytes;
};

/// Decides what is sent to whom and when, within the bytes that may be sent.
class Sender {
 public:
  explicit Sender(const ExchangeConfig& config) : config_(config), budget_(config.bytes_per_second) {}

  /// All that one call of send() works on.
  struct Round {
    Time now{};
    const StatusMessages& status;
    const Layers& layers;
    LinkTable& links;
    const InterestOf& interest_of;
    std::vector<Outgoing>& out;  ///< datagrams are appended
  };
  /// Sends an announcement if one is due, then where robot and people are, then items that peers lack while the bytes
  /// last, then the statuses that are due and went along with no items. Announcements and statuses are sent in any
  /// case.
  void send(const Round& round);

 private:
  void announce(const Round& round);
  void send_bodies(const Round& round);
  void send_items(const Round& round);
  void send_statuses(const Round& round);
  void send_layer(const Round& round, const Delivery& delivery, Link& link);
  void give_up_overdue(Link& link, Time now) const;
  void note_status(Link& link, const Datagram& datagram, std::size_t bytes, const Round& round) const;
  [[nodiscard]] double cost_of(const std::vector<std::byte>& bytes) const {
    return static_cast<double>(bytes.size() + config_.overhead_bytes);
  }

  ExchangeConfig config_;
  ByteBudget budget_;
  Time next_announcement_ = Time::min();
  RobotId next_peer_ = 0;  // whose turn it is
};

}  // namespace cairn::peers
