// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "tools/simulator/live/driven_body.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {

/// The world of a live simulation, and where the robot stands in it first.
struct LiveStage {
  World world;
  FloorPlan plan;
  Tracer tracer;
  GroundPose start;

  /// `start` null: where robot 1 of simulate() starts with this seed. Errors: kInvalidConfig (no such scene, or no room
  /// for the robot at `start`, with a place that has), kLimit.
  [[nodiscard]] static Result<LiveStage> make(std::string_view scene, std::uint64_t seed,
                                              const std::optional<GroundPose>& start);
};

}  // namespace cairn::simulator
