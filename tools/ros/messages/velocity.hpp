// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "hal/time.hpp"
#include "tools/ros/messages/types.hpp"

namespace cairn::ros {

/// What a robot on wheels can do of a Twist.
struct Velocity {
  double v = 0;  ///< m/s forward, of base_link
  double w = 0;  ///< rad/s to the left
};

/// Whether a message from the network may move the robot.
enum class Verdict : std::uint8_t {
  kTake,
  kNotFinite,    ///< a number that is none
  kNotPossible,  ///< it moves sideways, up, or about another axis than z: not for wheels
  kTooOld,  ///< stamped more than kMostAge ago, or as much in the future: the clocks differ, or the network is slow
};
[[nodiscard]] std::string_view to_string(Verdict verdict);

/// Age from which on what has a stamp is refused.
inline constexpr Duration kMostAge = std::chrono::milliseconds(500);

/// A Twist has no stamp: it counts from when it came. `velocity` is set if it is taken.
[[nodiscard]] Verdict judge(const Twist& twist, Velocity& velocity);
/// `utc`: now, of this machine's realtime clock.
[[nodiscard]] Verdict judge(const TwistStamped& twist, Duration utc, Velocity& velocity);
/// Of what was written at `written`, nanoseconds UTC of the writer's clock.
[[nodiscard]] Verdict judge_age(Duration written, Duration utc);

}  // namespace cairn::ros
