// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/door/fitted.hpp"

#include <algorithm>

namespace cairn {

bool has_kind(std::span<const recording::SourceEntry> sources, std::string_view kind) {
  return std::ranges::any_of(sources, [&](const recording::SourceEntry& entry) { return entry.kind == kind; });
}

Fitted fitted_with(std::span<const recording::SourceEntry> sources, const RobotProfile& profile) {
  const auto has = [&](std::string_view kind) { return has_kind(sources, kind); };
  Fitted fitted;
  fitted.watched = {has(recording::kVelodyne) || has(recording::kScans), has(recording::kCamera),
                    has(recording::kThermal), has(recording::kDepth), has(recording::kDrive)};
  fitted.drive = has(recording::kDrive);
  fitted.estop = has(recording::kGpio) && !profile.gpio.driver.estop_line.empty();
  return fitted;
}

}  // namespace cairn
