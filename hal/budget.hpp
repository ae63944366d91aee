// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/clock.hpp"
#include "hal/time.hpp"

namespace cairn {

/// A ticket for bounded work: `while (budget.one_more()) refine();`. The first step is the mandatory result and always
/// granted; after that the step limit decides and, where there is one, the deadline. In virtual time the clock stands
/// still while a stage works, so the step limit alone decides and a replay spends what it must.
class Budget {
 public:
  [[nodiscard]] static Budget steps(int limit) { return Budget(nullptr, {}, limit); }
  /// `clock` must outlive the budget.
  [[nodiscard]] static Budget until(Time deadline, const Clock& clock, int limit) {
    return Budget(&clock, deadline, limit);
  }

  [[nodiscard]] bool one_more() {
    const bool granted = spent_ == 0 || (spent_ < limit_ && !(clock_ != nullptr && clock_->now() >= deadline_));
    spent_ += granted ? 1 : 0;
    return granted;
  }
  [[nodiscard]] int spent() const { return spent_; }

 private:
  Budget(const Clock* clock, Time deadline, int limit) : clock_(clock), deadline_(deadline), limit_(limit) {}

  const Clock* clock_;
  Time deadline_;
  int limit_;
  int spent_ = 0;
};

}  // namespace cairn
