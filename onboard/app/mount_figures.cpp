// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/mount_figures.hpp"

#include <numbers>

namespace cairn::app {

void add_mounts(const RobotTasks& tasks, report::RunReport& report) {
  if (!tasks.mounts) return;
  constexpr double kToDegrees = 180 / std::numbers::pi;
  for (const MountTask::Watched& eye : tasks.mounts->watched()) {
    const mount::MountWatch& watch = eye.parts.watch;
    report::MountStats& stats = report.mounts.emplace_back();
    stats.camera = eye.parts.source;
    stats.kind = eye.parts.eye == people::Eye::kThermal ? "thermal" : "colour";
    stats.images = eye.figures.images;
    stats.pairs = watch.pairs();
    stats.passed = eye.figures.passed;
    stats.shed = eye.figures.shed;
    stats.refused = eye.figures.refused;
    stats.moved = watch.moved();
    if (!watch.estimate()) continue;
    stats.turn_deg = kToDegrees * watch.estimate()->turn_rad;
    stats.deviation_deg = kToDegrees * watch.estimate()->covariance.diagonal().cwiseSqrt();
  }
}

}  // namespace cairn::app
