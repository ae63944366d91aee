// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/simulator/motion/drive.hpp"
#include "tools/simulator/motion/path.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// What a small quadrotor does; it is in the air when a recording starts.
struct FlightLimits {
  DriveLimits level{2.5, 1.5, 1.2, 2.5};  ///< in the plane
  double climb = 0.6;                     ///< m/s
};

/// The part of the world that a flight between `world.flight`'s heights has to keep clear of.
[[nodiscard]] FloorPlan flight_plan(const World& world);

/// Flies along `path`, looking ahead, rising and sinking between `world.flight`'s heights above the ground; leans into
/// accelerations and curves as a quadrotor must: its thrust points along the sum of gravity and acceleration.
[[nodiscard]] Trajectory fly(const World& world, const FloorPlan& plan, const Path& path, Time start, Duration duration,
                             const FlightLimits& limits, std::uint64_t seed);

}  // namespace cairn::simulator
