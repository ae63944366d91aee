// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <utility>

namespace cairn::app {

/// Large values that wait, the oldest first. Memory of those that have gone is used again.
template <class T>
class WaitingList {
 public:
  /// Takes the value; what is left in `value` is memory to be used again.
  void add(T& value) {
    if (spare_.empty()) spare_.emplace_back();
    std::swap(spare_.front(), value);
    waiting_.push_back(std::move(spare_.front()));
    spare_.pop_front();
  }
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] const T& front() const { return waiting_.front(); }
  void pop() {
    spare_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }

 private:
  std::deque<T> waiting_, spare_;
};

}  // namespace cairn::app
