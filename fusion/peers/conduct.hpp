// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>

#include "hal/time.hpp"

namespace cairn::peers {

/// Whether a peer is listened to. A peer that sends ten invalid datagrams within a minute is banned for a minute. Each
/// further ban is twice as long as the last, up to an hour. After an hour without a ban the next one is short again.
class Conduct {
 public:
  static constexpr std::size_t kFaults = 10;  ///< invalid datagrams within kWindow
  static constexpr Duration kWindow = std::chrono::seconds(60), kFirstBan = std::chrono::seconds(60),
                            kLongestBan = std::chrono::hours(1);

  /// The peer has sent an invalid datagram.
  void fault(Time now) {
    while (!faults_.empty() && faults_.front() + kWindow < now) faults_.pop_front();
    faults_.push_back(now);
    if (faults_.size() < kFaults) return;
    faults_.clear();
    if (banned_until_ + kLongestBan < now) ban_ = kFirstBan;
    banned_until_ = now + ban_;
    ban_ = std::min(2 * ban_, kLongestBan);
  }
  [[nodiscard]] bool banned(Time now) const { return now < banned_until_; }

 private:
  std::deque<Time> faults_;
  Time banned_until_{};
  Duration ban_ = kFirstBan;
};

}  // namespace cairn::peers
