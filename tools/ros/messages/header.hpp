// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "hal/time.hpp"
#include "tools/ros/messages/arena.hpp"
#include "tools/ros/messages/types.hpp"

namespace cairn::ros {

/// Names of the frames of one robot.
struct Frames {
  explicit Frames(std::string_view before = {})
      : odom(std::string(before) + "odom"), base_link(std::string(before) + "base_link"), prefix(before) {}
  std::string odom, base_link;
  std::string team = "team";  ///< one for all robots of a team, so without a prefix
  std::string prefix;         ///< of sensors
};

/// UTC as ROS writes it. `utc_offset` added to robot time gives UTC. Times before 1970 become 0, those after 2038 the
/// last that ROS can write.
[[nodiscard]] Stamp stamp_of(Time time, Duration utc_offset);
/// UTC in nanoseconds.
[[nodiscard]] Duration utc_of(const Stamp& stamp);
[[nodiscard]] Header header_of(Time time, Duration utc_offset, std::string_view frame, Arena& arena);

/// The offset from robot time to UTC. The core says it once; this follows later steps of the machine's clock, such as
/// the first answer of a time server.
class UtcOffset {
 public:
  /// `core`: as the core has just said it; `machine`: LiveClock::realtime_offset() now.
  void greeted(Duration core, Duration machine) {
    offset_ = core;
    machine_ = machine;
  }
  /// To be called now and then. Differences below kStep are left alone: they are those of two readings.
  void follow(Duration machine) {
    const Duration step = machine - machine_;
    if (step < kStep && step > -kStep) return;
    offset_ += step;
    machine_ = machine;
  }
  [[nodiscard]] Duration value() const { return offset_; }

 private:
  static constexpr Duration kStep = std::chrono::milliseconds(5);
  Duration offset_{}, machine_{};
};

}  // namespace cairn::ros
