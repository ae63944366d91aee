// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <vector>

#include "hal/ports.hpp"

namespace cairn::recording {

/// What happens to a source for a while.
enum class Spell : std::uint8_t {
  kSilence,     ///< nothing arrives
  kDisconnect,  ///< nothing arrives, and the transport says so once: kLinkDown
  kStuck,       ///< the bytes of the last good packet arrive again and again
  kBurst,       ///< what was sent arrives at the end of the spell, all at once
};

/// What goes wrong between a sensor and its decoder. Shares are of a source's packets, 0 … 1.
struct Faults {
  double drop = 0;    ///< never arrives; its sequence number is missing
  double repeat = 0;  ///< arrives twice
  double swap = 0;    ///< arrives after the packet that follows it from any source
  double cut = 0;     ///< arrives without its end, marked as truncated
  double flip = 0;    ///< arrives with one bit turned
  double extend = 0;  ///< arrives with up to 64 bytes more
  double delay = 0;   ///< arrives later by `delay_by`, among the packets of that time
  Duration delay_by = std::chrono::milliseconds(50);
  Spell spell = Spell::kSilence;
  Duration freeze{};             ///< length of the spell at the end of each `period`
  Duration period{};             ///< zero: there is no spell
  Duration shift{};              ///< each arrival is stamped later by so much (negative: earlier), after `shift_after`
  Duration shift_after{};        ///< since the first packet
  std::optional<SourceId> only;  ///< of this source alone; none: of all
  std::uint64_t seed = 1;        ///< the same faults for the same packets
};

/// Puts the faults of cables, radios and slow computers between a transport and its decoder. The decoder sees no
/// difference to real faults.
class FaultySource final : public Source {
 public:
  /// How many packets each fault changed.
  struct Counters {
    std::uint64_t packets = 0, dropped = 0, repeated = 0, swapped = 0, cut = 0, flipped = 0, frozen = 0;
    std::uint64_t extended = 0, delayed = 0, stuck = 0, burst = 0, shifted = 0, disconnects = 0;
  };

  /// `inner` must outlive it.
  FaultySource(Source& inner, const Faults& faults) : inner_(inner), faults_(faults), random_(faults.seed) {}

  Result<Poll> next(Packet& packet, Duration timeout) override;
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool happens(double share);
  [[nodiscard]] bool in_spell(Time arrival) const;
  void take(Packet& packet);
  /// False: the packet does not arrive now.
  bool pass_spell(Packet& packet);
  bool pass(Packet& packet);
  void damage(Packet& packet);
  void release_until(Time arrival);
  void release_all();

  // What waits is bounded: a source may stamp its packets as it likes.
  static constexpr std::size_t kMaxWaiting = 4096;

  Source& inner_;
  Faults faults_;
  std::mt19937_64 random_;
  std::optional<Time> first_;
  std::optional<Packet> held_;   // swapped: arrives after the next one
  std::vector<Packet> delayed_;  // in order of arrival
  std::vector<Packet> burst_;    // of the spell that lasts
  std::optional<Packet> good_;   // the last one before a spell
  bool connected_ = true, complain_ = false;
  std::deque<Packet> out_;  // arrives now, before anything new
  Counters counters_;
};

}  // namespace cairn::recording
