// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "hal/ports.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::scheduler {

/// Hands the packets of one source to one task. What a tick gets is
/// - live: what has arrived, and how many is logged;
/// - logged: as many as then;
/// - virtual: what arrived up to the tick's release.
class Feed {
 public:
  /// Sees every packet before it is used; for recording.
  using Tap = std::function<void(const Packet&)>;
  /// Gets the errors of the source; on the task's thread.
  using Complain = std::function<void(Time, const Error&)>;
  /// A live tick takes no more packets, so a flood cannot hold the task.
  static constexpr int kMaxPackets = 2000;
  /// Bytes. Smaller packets, such as an edge or a CAN frame, never allocate.
  static constexpr std::size_t kSmall = 192;

  /// `source` must outlive the feed. Packets get `id`. `slot` is one of the task's, in the schedule log.
  Feed(Source& source, SourceId id, std::size_t slot, Complain complain, Tap tap = {})
      : source_(source), id_(id), slot_(slot), complain_(std::move(complain)), tap_(std::move(tap)) {
    packet_.bytes.reserve(kSmall);
    next_.bytes.reserve(kSmall);
  }

  /// The next packet of this tick, or null. It stays valid until the next call.
  const Packet* take(Tick& tick);

  /// No packet will follow.
  [[nodiscard]] bool ended() const { return ended_ && !ahead_; }
  /// The arrival of the next packet, which is read ahead. Time::max(): there is none.
  [[nodiscard]] Time first_arrival();
  /// Packets that logged ticks had and that are not there: the recording is not that of the log.
  [[nodiscard]] std::uint64_t missing() const { return missing_; }

 private:
  bool read(Time now, int limit);
  const Packet* take_ahead();

  Source& source_;
  SourceId id_;
  std::size_t slot_;
  Complain complain_;
  Tap tap_;
  Packet packet_, next_;
  bool ahead_ = false;  // next_ is read and not taken
  bool ended_ = false;
  std::uint64_t taking_ = ~std::uint64_t{0};
  std::int32_t taken_ = 0;
  std::uint64_t missing_ = 0;
};

}  // namespace cairn::scheduler
