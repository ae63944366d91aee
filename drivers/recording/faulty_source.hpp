// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "hal/ports.hpp"

namespace cairn::recording {

/// What goes wrong between a sensor and its decoder. Shares are of a source's packets, 0 … 1.
struct Faults {
  double drop = 0;               ///< never arrives; its sequence number is missing
  double repeat = 0;             ///< arrives twice
  double swap = 0;               ///< arrives after the packet that follows it from any source
  double cut = 0;                ///< arrives without its end, marked as truncated
  double flip = 0;               ///< arrives with one bit turned
  Duration freeze{};             ///< so long …
  Duration period{};             ///< … in every such period nothing arrives; zero: never
  std::optional<SourceId> only;  ///< of this source alone; none: of all
  std::uint64_t seed = 1;        ///< the same faults for the same packets
};

/// The faults of cables, radios and tired computers, between any transport and its decoder: the decoder cannot tell
/// them from real ones.
class FaultySource final : public Source {
 public:
  struct Counters {
    std::uint64_t packets = 0, dropped = 0, repeated = 0, swapped = 0, cut = 0, flipped = 0, frozen = 0;
  };

  /// `inner` must outlive it.
  FaultySource(Source& inner, const Faults& faults) : inner_(inner), faults_(faults), random_(faults.seed) {}

  Result<Poll> next(Packet& packet, Duration timeout) override;
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool happens(double share);
  [[nodiscard]] bool is_frozen(Time arrival);
  /// False: the packet does not arrive now.
  bool pass(Packet& packet);
  void damage(Packet& packet);

  Source& inner_;
  Faults faults_;
  std::mt19937_64 random_;
  std::optional<Time> first_;
  std::optional<Packet> held_;   // swapped: arrives after the next one
  std::optional<Packet> again_;  // arrives now, before anything new
  Counters counters_;
};

}  // namespace cairn::recording
