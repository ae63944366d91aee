// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/simulator/motion/path.hpp"
#include "tools/simulator/motion/style.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// Drives a differential-drive robot along `path` for `duration`: it rests for a second, then follows by pure pursuit,
/// slower in curves and narrow places, and turns on the spot where the path doubles back. Height, roll and pitch follow
/// from the ground under the four wheels. `seed` sets the cruising speed.
[[nodiscard]] Trajectory drive(const World& world, const FloorPlan& plan, const Path& path, Time start,
                               Duration duration, const DriveLimits& limits, std::uint64_t seed,
                               const SuddenStops& stops = {});

/// base_link as x y z roll pitch yaw when the robot stands on `world`'s ground at (x, y) with heading `yaw`.
[[nodiscard]] Vector6 on_ground(const World& world, double x, double y, double yaw);

}  // namespace cairn::simulator
