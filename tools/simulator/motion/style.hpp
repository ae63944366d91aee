// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "tools/simulator/motion/trajectory.hpp"

namespace cairn::simulator {

/// What the robot's base can do.
struct DriveLimits {
  double speed = 1.5;             ///< m/s
  double acceleration = 0.8;      ///< m/s², forward, and braking that was planned
  double yaw_rate = 1.0;          ///< rad/s
  double yaw_acceleration = 2.0;  ///< rad/s²
};

/// Stops that nobody planned, as an emergency stop makes them.
struct SuddenStops {
  double every_s = 0;   ///< s, mean time between them; 0: none
  double rest_s = 1.0;  ///< s, until the robot drives on
  double braking = 6;   ///< m/s²
};

/// Cables, kerbs and holes that the wheels roll over. Sizes are the largest, at full speed.
struct Bumps {
  double every_s = 0;       ///< s, mean time between them; 0: none
  double pitch_rad = 0;     ///< rad
  double roll_rad = 0;      ///< rad
  double height_m = 0;      ///< m
  double duration_s = 0.2;  ///< s, up and down again
};

/// How a walking person carries the sensor. Amplitudes are those at a walk of 1 m/s.
struct Gait {
  double carried_m = 0;  ///< m above where a robot's base would be; 0: nobody carries it
  double steps_hz = 1.9;
  double bob_m = 0.03;         ///< m, up and down once a step
  double sway_m = 0.03;        ///< m, left and right once in two steps
  double nod_rad = 0.05;       ///< rad of pitch once a step
  double roll_rad = 0.06;      ///< rad once in two steps
  double look_yaw_rad = 0.45;  ///< rad, looking around, also at rest
  double look_tilt_rad = 0.15;
};

/// How a robot moves: from what suits a camera's eye to what an emergency or a hand does.
enum class Motion : std::uint8_t {
  kGentle,      ///< up to 1.5 m/s and 60°/s, never abrupt: the default
  kBrisk,       ///< up to 2 m/s and 90°/s, onsets of 0.2 s, small bumps
  kAggressive,  ///< up to 3 m/s and 120°/s, onsets of 0.1 s, bumps in pitch and roll, sudden stops
  kHandheld,    ///< carried by a person who walks and looks around
};
inline constexpr std::array<std::string_view, 4> kMotions{"gentle", "brisk", "aggressive", "handheld"};
[[nodiscard]] constexpr std::string_view to_string(Motion motion) { return kMotions[static_cast<std::size_t>(motion)]; }
/// `name` must be one of kMotions.
[[nodiscard]] Motion motion_of(std::string_view name);

struct MotionStyle {
  DriveLimits limits;
  SuddenStops stops;
  Bumps bumps;
  Gait gait;
};
[[nodiscard]] MotionStyle style_of(Motion motion);

/// `smooth` with bumps, or as a person would carry the sensor along it. Unchanged if the style has neither.
[[nodiscard]] Trajectory shaken(const Trajectory& smooth, const MotionStyle& style, std::uint64_t seed);

}  // namespace cairn::simulator
