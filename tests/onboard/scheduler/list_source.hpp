// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "hal/clock.hpp"
#include "hal/ports.hpp"

namespace cairn::scheduler::test {

/// Packets that arrive at given times; each holds its number in its sequence. With a clock they come when their time
/// has come, as from a device.
class ListSource final : public Source {
 public:
  explicit ListSource(std::vector<Time> arrivals, const Clock* clock = nullptr)
      : arrivals_(std::move(arrivals)), clock_(clock), limit_(arrivals_.size()) {}

  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (complaints_ > 0) {
      --complaints_;
      return Error{Errc::kIo, "as told"};
    }
    if (next_ == arrivals_.size()) return Poll::kEnd;
    if (next_ >= limit_ || (clock_ != nullptr && clock_->now() < arrivals_[next_])) return Poll::kTimeout;
    packet.arrival = arrivals_[next_];
    packet.sequence = next_++;
    return Poll::kPacket;
  }
  void set_limit(std::size_t limit) { limit_ = limit; }
  void complain(int times) { complaints_ = times; }

 private:
  std::vector<Time> arrivals_;
  const Clock* clock_;
  std::size_t limit_, next_ = 0;
  int complaints_ = 0;
};

}  // namespace cairn::scheduler::test
