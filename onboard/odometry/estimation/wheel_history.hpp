// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "hal/drive.hpp"

namespace cairn::odometry {

/// The last second of wheel states, to ask for one at a time in between.
class WheelHistory {
 public:
  static constexpr Duration kKept = std::chrono::seconds(1);
  static constexpr Duration kMaxAge = std::chrono::milliseconds(100);  ///< an older state says nothing of a time

  void add(const DriveState& state);
  /// The newest state up to `t`, moved on with its velocity. None where there is none, or only an older one.
  [[nodiscard]] std::optional<DriveState> at(Time t) const;

 private:
  std::deque<DriveState> states_;  // by stamp
};

}  // namespace cairn::odometry
