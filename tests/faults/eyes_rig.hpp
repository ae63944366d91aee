// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/monitor.hpp"
#include "onboard/robot.hpp"
#include "onboard/safety/failsafe.hpp"

namespace cairn::faults {

/// How a camera is wrong, all the time.
enum class Ill {
  kNot,
  kSilent,
  kFrozen,
  kOverexposed,
  kCorrecting,  ///< a thermal camera's flat-field correction that does not end
  kTurned,      ///< its mount is 2° off, to the left
};

/// What a robot did that drove four seconds towards four people who stand there, while its two cameras look for people.
/// Nothing but the cameras can tell that these are people.
struct EyesOutcome {
  bool ran = false;
  std::vector<TrackPoint> track;
  std::size_t body_voxels = 0;  ///< occupied, where people stand
  std::size_t people = 0;       ///< followed at the end
  std::uint64_t colour_looked = 0, thermal_looked = 0;
  std::optional<double> colour_offset, thermal_offset;  ///< of boxes from people, rad; see people::EyeOffset
  safety::FailsafeDecision decision;
  std::vector<Event> events;

  [[nodiscard]] bool has_event(const std::string& what) const;
};

/// The robot's own tasks, from packets to the map, in virtual time.
[[nodiscard]] EyesOutcome drive_with(Ill colour, Ill thermal);

}  // namespace cairn::faults
