// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/clock.hpp"
#include "hal/time.hpp"

namespace cairn {

/// A limit on the steps of an iterative stage: `while (budget.one_more()) refine();`. The first step is always granted.
/// Further steps are granted up to the limit and, where there is one, until the deadline. In virtual time the clock
/// stands still while a stage works, so only the limit decides.
class Budget {
 public:
  /// At most `limit` steps, and no deadline.
  [[nodiscard]] static Budget steps(int limit) { return Budget(nullptr, {}, limit); }
  /// At most `limit` steps, and none after `deadline`. `clock` must outlive the budget.
  [[nodiscard]] static Budget until(Time deadline, const Clock& clock, int limit) {
    return Budget(&clock, deadline, limit);
  }

  /// True if one more step is granted; it is then counted.
  [[nodiscard]] bool one_more() {
    const bool granted = spent_ == 0 || (spent_ < limit_ && !(clock_ != nullptr && clock_->now() >= deadline_));
    spent_ += granted ? 1 : 0;
    return granted;
  }
  /// Steps granted so far.
  [[nodiscard]] int spent() const { return spent_; }

 private:
  Budget(const Clock* clock, Time deadline, int limit) : clock_(clock), deadline_(deadline), limit_(limit) {}

  const Clock* clock_;
  Time deadline_;
  int limit_;
  int spent_ = 0;
};

}  // namespace cairn
