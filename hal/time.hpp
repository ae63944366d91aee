// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace cairn {

/// Tag for robot time. It has no now(): only a Clock can tell the time.
struct RobotTime {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<RobotTime>;
  static constexpr bool is_steady = true;
};

/// Nanoseconds on the robot's monotonic time line. In a replay it is the time line of the recording.
using Time = RobotTime::time_point;
/// Nanoseconds between two Times.
using Duration = RobotTime::duration;

/// The interval in which data was measured. A LiDAR scan takes a tenth of a second.
struct TimeRange {
  Time start{}, end{};
  friend bool operator==(const TimeRange&, const TimeRange&) = default;
};

/// The same in seconds or milliseconds, rounded to a double.
[[nodiscard]] constexpr double to_seconds(Duration d) { return 1e-9 * static_cast<double>(d.count()); }
[[nodiscard]] constexpr double to_seconds(Time t) { return to_seconds(t.time_since_epoch()); }
[[nodiscard]] constexpr double to_milliseconds(Duration d) { return 1e-6 * static_cast<double>(d.count()); }

/// Rounds to the nearest nanosecond. The caller guarantees |seconds| < 9.2e9.
[[nodiscard]] constexpr Duration from_seconds(double seconds) {
  const double ns = seconds * 1e9;
  return Duration{static_cast<std::int64_t>(ns < 0 ? ns - 0.5 : ns + 0.5)};
}

}  // namespace cairn
