// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "drivers/drive/can/can_frame.hpp"
#include "hal/time.hpp"

namespace cairn::drive {

/// Frames waiting to be sent, oldest first. A frame that says the same as one waiting (same identifier and, for NMT,
/// same node) takes its place, so that no stale command can pile up behind a bus that does not acknowledge.
class TxQueue {
 public:
  static constexpr std::size_t kCapacity = 24;

  /// False when the queue is full; the frame is then dropped and counted.
  bool push(const CanFrame& frame);
  /// Removes the first `n`.
  void drop_front(std::size_t n);
  void clear() { size_ = 0; }
  [[nodiscard]] std::span<const CanFrame> frames() const { return std::span(frames_).first(size_); }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  std::array<CanFrame, kCapacity> frames_{};
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

/// A period with phase: due once per period; releases that were missed are skipped.
class Every {
 public:
  explicit Every(Duration period) : period_(period) {}
  bool due(Time now) {
    if (started_ && now < next_) return false;
    next_ = started_ ? next_ + period_ * ((now - next_) / period_ + 1) : now + period_;
    return started_ = true;
  }
  /// Makes the next call due.
  void now() { started_ = false; }

 private:
  Duration period_;
  Time next_{};
  bool started_ = false;
};

}  // namespace cairn::drive
