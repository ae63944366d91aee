// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/thermal/thermal.hpp"
#include "hal/result.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/labelling/thermal_lifter.hpp"

namespace cairn::app {

/// What thermal clouds are made with.
struct ThermalParts {
  thermal::Thermal camera;
  labelling::ThermalLifter lifter;
};

/// As the profile says. Errors: kNotFound (no thermal camera among `sources`), kInvalidConfig (it is not calibrated, or
/// a value does not fit).
[[nodiscard]] Result<ThermalParts> open_thermal(const RobotProfile& profile,
                                                std::span<const recording::SourceEntry> sources);

}  // namespace cairn::app
