// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/profile/robot_profile.hpp"
#include "tools/simulator/simulate.hpp"

namespace cairn::simulator {

/// The robot profile that decodes what simulate() records with this config: mounts, intrinsics, scales as their owner
/// would have configured them (the truth differs by what nobody knows: WheelConfig). Devices are left empty: the robot
/// is replayed only.
[[nodiscard]] app::RobotProfile simulated_profile(const SimulationConfig& config);

}  // namespace cairn::simulator
