// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace cairn {

/// A counter that one thread changes and any thread may read. Reads of several counters are not ordered, so it is for
/// figures only. For its writer it is as cheap as a plain integer. It can be copied like one.
class RelaxedCounter {
 public:
  RelaxedCounter(std::uint64_t value = 0) : value_(value) {}  // NOLINT(google-explicit-constructor): it is a number
  RelaxedCounter(const RelaxedCounter& other) : value_(other.get()) {}
  RelaxedCounter& operator=(const RelaxedCounter& other) {
    value_.store(other.get(), std::memory_order_relaxed);
    return *this;
  }
  ~RelaxedCounter() = default;

  RelaxedCounter& operator+=(std::uint64_t n) {
    value_.store(get() + n, std::memory_order_relaxed);
    return *this;
  }
  RelaxedCounter& operator++() { return *this += 1; }
  [[nodiscard]] std::uint64_t get() const { return value_.load(std::memory_order_relaxed); }
  operator std::uint64_t() const { return get(); }  // NOLINT(google-explicit-constructor)

 private:
  std::atomic<std::uint64_t> value_;
};

}  // namespace cairn
