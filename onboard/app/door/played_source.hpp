// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "hal/clock.hpp"
#include "hal/ports.hpp"

namespace cairn::app {

/// A recorded source that behaves like a device. Each packet arrives again, later by the shift, when the clock has come
/// to that time. Never waits.
class PlayedSource final : public Source {
 public:
  /// `clock` must outlive the source.
  PlayedSource(std::unique_ptr<Source> recorded, const Clock& clock) : recorded_(std::move(recorded)), clock_(clock) {}

  /// The recorded arrival of the first packet. Call it once, before next(). Time::max(): no packet can be read.
  [[nodiscard]] Time first_arrival() {
    const auto poll = recorded_->next(ahead_, Duration{0});
    has_ahead_ = poll && *poll == Poll::kPacket;
    return has_ahead_ ? ahead_.arrival : Time::max();
  }
  void set_shift(Duration shift) { shift_ = shift; }

  Result<Poll> next(Packet& packet, Duration timeout) override {
    if (!has_ahead_) {
      const auto poll = recorded_->next(ahead_, timeout);
      if (!poll || *poll != Poll::kPacket) return poll;
      has_ahead_ = true;
    }
    if (clock_.now() < ahead_.arrival + shift_) return Poll::kTimeout;
    std::swap(packet, ahead_);
    packet.arrival += shift_;
    has_ahead_ = false;
    return Poll::kPacket;
  }

 private:
  std::unique_ptr<Source> recorded_;
  const Clock& clock_;
  Duration shift_{};
  Packet ahead_;
  bool has_ahead_ = false;
};

}  // namespace cairn::app
