// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "hal/time.hpp"

namespace cairn::velodyne {

/// The offset from a device's clock to the robot's time line, from samples that transport can only make too large.
///
/// The offset follows the smallest sample of the last one to two seconds, never by a step: by kSlowSlew as a rule, and
/// faster where it is found to be too large. It is then at most 1/kSteepest slower than the device's clock.
class DelayFilter {
 public:
  /// Begins at `offset`, which may be larger than the first `sample`.
  void begin(Duration sample, Duration offset, Time arrival);
  /// Adds a sample. True: the window that just ended was later than kMaxWindowError as a whole.
  bool add(Duration sample, Time arrival);
  /// Moves the offset after the device's clock made `step`. It goes back by at most `most_back` (not negative).
  void advance(Duration step, Time arrival, Duration most_back);

  [[nodiscard]] Duration offset() const { return offset_; }
  /// The smallest sample of the last one to two seconds.
  [[nodiscard]] Duration smallest() const { return std::min(previous_min_, window_min_); }
  /// The share of time that the offset is being reduced by; 0 unless it was found to be too large.
  [[nodiscard]] double catch_up() const;

  static constexpr Duration kWindow = std::chrono::seconds(1);  ///< over which the smallest sample is taken
  static constexpr Duration kMaxWindowError = std::chrono::milliseconds(10);
  static constexpr int kFastSlew = 100;   ///< one part in … during the first window
  static constexpr int kSlowSlew = 2000;  ///< one part in … later: 500 ppm follows any crystal
  static constexpr int kSteepest = 5;     ///< one part in … at most
  static constexpr Duration kCatchUp = std::chrono::milliseconds(500);  ///< time constant of getting smaller

 private:
  Duration offset_{};
  Time since_{};  // arrival at which it began
  Time window_start_{};
  Duration window_min_{}, previous_min_{};  // smallest samples of the running window and the one before
};

}  // namespace cairn::velodyne
