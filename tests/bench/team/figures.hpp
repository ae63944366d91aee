// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "fusion/peers/datagrams/datagram_part.hpp"
#include "fusion/team/team.hpp"
#include "hal/time.hpp"

namespace cairn::bench {

/// What a robot has sent, each datagram with what carries it, by what was in it.
class SentBytes {
 public:
  static constexpr std::size_t kOverhead = 100;  // of RTPS, UDP and IP, about

  void add(std::span<const std::byte> datagram, std::size_t copies);
  [[nodiscard]] std::uint64_t all() const;
  void print() const;

 private:
  struct Kind {
    std::uint64_t datagrams = 0, bytes = 0;
  };
  std::array<Kind, peers::kAllParts + 1> kinds_{};  // by the parts that a datagram has
};

/// What a robot has sent and received, in items.
void print_items(const team::Team& team);

/// How long it takes from when a robot says something until it is in the map that a teammate shows, or until something
/// newer of the same tile is. What was said before the map showed anything of the robot does not count.
class Ages {
 public:
  /// Of one's own, after each step.
  void said(const team::Team& team, Time now);
  /// Of another's, after each fuse().
  void fused(const team::Team& team, Time now);
  /// In seconds, `q` of 0…1, of what was said no later than `until`; 0 where there is nothing.
  [[nodiscard]] double quantile(double q, Time until = Time::max()) const;
  [[nodiscard]] std::size_t count() const { return ages_.size(); }

 private:
  using Way = std::pair<peers::RobotId, peers::RobotId>;  // from, to
  std::map<peers::RobotId, std::vector<Time>> said_;      // of each version, from the first
  std::map<Way, std::vector<peers::Version>> waits_;
  std::map<Way, peers::Version> looked_at_;
  std::vector<std::pair<Time, double>> ages_;  // when it was said, s
};

}  // namespace cairn::bench
