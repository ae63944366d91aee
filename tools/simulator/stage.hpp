// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/sensors/climate.hpp"
#include "tools/simulator/simulate.hpp"
#include "tools/simulator/world/tracer.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

inline constexpr Time kStart = Time(std::chrono::seconds(10));  ///< of every recording's own time line

/// Everything that the robots of one run share.
struct Stage {
  World world;
  FloorPlan plan;  ///< as the robots see it, on the ground or in the air
  Tracer tracer;
  std::vector<Trajectory> trajectories;  ///< one for each robot
  Crowd people;
  Climate climate;
  std::string world_ot;
  std::int64_t start_utc_ns;
};

}  // namespace cairn::simulator
