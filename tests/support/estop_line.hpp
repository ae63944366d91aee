// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "drivers/gpio/gpio_lines.hpp"

namespace cairn::support {

/// An e-stop's line whose contact and wire the test moves.
class EStopLine final : public gpio::GpioLines {
 public:
  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (edges.empty()) return Poll::kTimeout;
    packet = edges.front();
    edges.pop_front();
    return Poll::kPacket;
  }
  Result<bool> level(gpio::Line) override {
    if (!there) return Error{Errc::kIo, "the chip is gone"};
    return closed;
  }
  Result<void> set(gpio::Line, bool) override { return {}; }

  /// The contact moves, and the kernel sees the edge.
  void move(bool to, Time when) {
    closed = to;
    see_edge(to, when, ++sequence);
  }
  /// An edge alone.
  void see_edge(bool to, Time when, std::uint32_t number) {
    Packet& packet = edges.emplace_back();
    gpio::encode_event({gpio::Line::kEStop, to, false, number}, packet);
    packet.arrival = when;
  }
  std::deque<Packet> edges;  ///< not yet read
  bool closed = true, there = true;
  std::uint32_t sequence = 0;  ///< of the last edge
};

}  // namespace cairn::support
