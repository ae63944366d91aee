// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace cairn {

/// Hands the newest value from one writing thread to one reading thread (a triple buffer). Neither side ever waits for
/// the other. The reader sees only whole values, and never an older one after a newer one.
template <class T>
class LatestValue {
 public:
  /// Writer: the value to be filled; its content is what was written some rounds ago.
  [[nodiscard]] T& back() { return values_[write_]; }
  /// Writer: makes back() the newest value.
  void publish() { write_ = middle_.exchange(write_ | kFresh, std::memory_order_acq_rel) & kIndex; }
  /// Writer: copies `value` and makes it the newest.
  void publish(const T& value) {
    back() = value;
    publish();
  }

  /// Reader: moves on to the newest value; false when there is no newer one.
  bool refresh() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// Reader: the value of the last refresh(); T{} before the first.
  [[nodiscard]] const T& value() const { return values_[read_]; }

 private:
  static constexpr std::uint8_t kFresh = 4, kIndex = 3;
  std::array<T, 3> values_{};
  alignas(64) std::uint8_t write_ = 0;
  alignas(64) std::uint8_t read_ = 1;
  alignas(64) std::atomic<std::uint8_t> middle_{2};
};

}  // namespace cairn
