// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/time.hpp"

namespace cairn::scheduler {

/// What follows from the execution time of a tick. Pure.
/// - A soft overrun is only counted.
/// - After a hard overrun, the next release is skipped.
/// - After three hard overruns in a row, the task is demoted to every second release, until ten busy ticks in a row
/// kept
///   their hard budget.
class OverrunPolicy {
 public:
  /// Budgets of one tick. Zero: no such budget.
  OverrunPolicy(Duration soft, Duration hard) : soft_(soft), hard_(hard) {}

  /// What one tick came to, and what follows.
  struct Verdict {
    bool soft = false, hard = false;
    bool newly_demoted = false;
    std::uint64_t skip = 0;  ///< releases to leave out
  };
  /// After every tick. `busy`: it had work. Idle ticks do not count for a recovery.
  Verdict tick(Duration execution, bool busy) {
    Verdict v;
    v.soft = soft_ > Duration{} && execution > soft_;
    v.hard = hard_ > Duration{} && execution > hard_;
    if (v.hard) {
      good_ = 0;
      v.newly_demoted = ++bad_ >= kInARow && !demoted_;
      demoted_ = demoted_ || v.newly_demoted;
    } else if (busy) {
      bad_ = 0;
      if (demoted_ && ++good_ >= kToRecover) demoted_ = false;
    }
    v.skip = v.hard || demoted_ ? 1 : 0;
    return v;
  }
  [[nodiscard]] bool demoted() const { return demoted_; }

  static constexpr int kInARow = 3, kToRecover = 10;

 private:
  Duration soft_, hard_;
  int bad_ = 0, good_ = 0;
  bool demoted_ = false;
};

}  // namespace cairn::scheduler
