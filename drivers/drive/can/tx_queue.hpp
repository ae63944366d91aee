// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "drivers/drive/can/can_frame.hpp"
#include "hal/time.hpp"

namespace cairn::drive {

/// Frames that wait to be sent, oldest first. A frame replaces a waiting one with the same identifier (and, for NMT,
/// the same node). So old commands cannot pile up behind a bus that does not acknowledge.
class TxQueue {
 public:
  static constexpr std::size_t kCapacity = 24;

  /// False when the queue is full. The frame is then dropped and counted.
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

/// A period that keeps its phase. Missed times are skipped.
class Every {
 public:
  explicit Every(Duration period) : period_(period) {}
  /// True once per period, and at the first call.
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
