// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "hal/clock.hpp"
#include "hal/histogram.hpp"
#include "tools/simulator/lidar/lidar.hpp"
#include "tools/simulator/live/lateness.hpp"

namespace cairn::simulator {

/// Sends the datagrams of a LiDAR when they are due: data packets, and position packets as a real sensor has them.
class LidarPlayer {
 public:
  struct Counters {
    std::uint64_t data_packets = 0, position_packets = 0;
    std::uint64_t left_out = 0;  ///< data packets: too late to be worth sending
    std::uint64_t refused = 0;   ///< datagrams that the network did not take
  };
  enum class Kind : bool { kData, kPosition };
  /// Takes a datagram to the network.
  using Wire = std::function<Result<void>(Kind, std::span<const std::byte>)>;
  /// A world that is later than this goes on with what is due now.
  static constexpr Duration kMostBehind = std::chrono::milliseconds(100);

  /// All must outlive it.
  LidarPlayer(const Lidar& lidar, Wire wire, const Clock& clock)
      : lidar_(lidar), wire_(std::move(wire)), clock_(clock) {}

  /// When the next packet is due.
  [[nodiscard]] Time due() const { return lidar_.arrival(next_); }
  /// Sends one data packet if it is due at `known`, the time until which the robot's track is known. Error: that of the
  /// wire; the packet counts as refused, and the next one follows.
  Result<void> play(Time known);

  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] Lateness& lateness() { return lateness_; }
  [[nodiscard]] const Histogram& late() const { return late_; }  ///< how long after it was due a packet was sent

 private:
  void leave_out(Time known);
  Result<void> send_position(Time at);

  const Lidar& lidar_;
  Wire wire_;
  const Clock& clock_;
  std::uint64_t next_ = 0;
  Lidar::DataPacket data_{};
  Lidar::PositionPacket position_{};
  Counters counters_;
  Lateness lateness_;
  Histogram late_;
};

}  // namespace cairn::simulator
