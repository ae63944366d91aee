// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace cairn {

/// A bounded queue between one producing and one consuming thread. Both sides are wait-free: no lock, no loop, and no
/// allocation after construction. Elements are used in place, so their memory (the arrays of a scan, the bytes of a
/// packet) is kept from one round to the next.
template <class T>
class SpscQueue {
 public:
  /// Holds `capacity` (at least 1) elements.
  explicit SpscQueue(std::size_t capacity) : slots_(capacity + 1) {}

  /// Producer: the element to fill, or null while the queue is full. The consumer sees it after push().
  [[nodiscard]] T* back() {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    return next(end) == begin_.load(std::memory_order_acquire) ? nullptr : &slots_[end];
  }
  /// Producer: hands over the element of back(). Call it only after back() was not null.
  void push() { end_.store(next(end_.load(std::memory_order_relaxed)), std::memory_order_release); }

  /// Consumer: the oldest element, or null when there is none. It stays the consumer's until pop().
  [[nodiscard]] T* front() {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    return begin == end_.load(std::memory_order_acquire) ? nullptr : &slots_[begin];
  }
  /// Consumer: gives the element back. Call it only after front() was not null.
  void pop() { begin_.store(next(begin_.load(std::memory_order_relaxed)), std::memory_order_release); }

  /// Any thread. For a third thread the number may be out of date.
  [[nodiscard]] std::size_t size() const {
    const std::size_t begin = begin_.load(std::memory_order_acquire), end = end_.load(std::memory_order_acquire);
    return end >= begin ? end - begin : end + slots_.size() - begin;
  }
  [[nodiscard]] std::size_t capacity() const { return slots_.size() - 1; }

 private:
  [[nodiscard]] std::size_t next(std::size_t i) const { return i + 1 == slots_.size() ? 0 : i + 1; }

  static constexpr std::size_t kCacheLine = 64;
  std::vector<T> slots_;  // one stays empty, so that full and empty differ
  alignas(kCacheLine) std::atomic<std::size_t> begin_{0};
  alignas(kCacheLine) std::atomic<std::size_t> end_{0};
};

}  // namespace cairn
