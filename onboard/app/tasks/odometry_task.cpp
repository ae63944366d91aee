// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/odometry_task.hpp"

namespace cairn {

using scheduler::Regime;
using scheduler::Tick;

OdometryTask::OdometryTask(const RobotProfile& profile, ScanChannel& scans, MotionChannel& motions, Robot& robot,
                           Monitor& monitor, Progress progress)
    : deadline_(from_seconds(profile.odometry_deadline_s)),
      max_iterations_(profile.odometry.max_iterations),
      scans_(scans),
      motions_(motions),
      robot_(robot),
      monitor_(monitor),
      latency_(monitor.stage("packet_to_pose")),
      progress_(std::move(progress)) {}

void OdometryTask::tick(Tick& tick) {
  while (const ArrivedScan* arrived = scans_.take(tick)) {
    locate(*arrived, tick);
    if (tick.regime() != Regime::kDrain) break;
  }
  scans_.give_back(tick);
}

void OdometryTask::locate(const ArrivedScan& arrived, Tick& tick) {
  ArrivedMotion* out = motions_.back(tick);
  Budget budget = tick.budget(kStepsSlot, arrived.scan.valid.end + deadline_, max_iterations_);
  const auto located = robot_.locate(arrived.scan, budget, out != nullptr ? out->scan : dropped_);
  tick.settle(kStepsSlot, budget);
  if (!located) {
    monitor_.event(arrived.scan.valid.end, "odometry", to_string(located.error()));
  } else if (out == nullptr) {
    monitor_.event(arrived.scan.valid.end, "odometry", "a scan did not get into the map: mapping is behind");
  } else {
    out->arrival = arrived.arrival;
    motions_.push(tick);
  }
  if (tick.takes_time()) latency_.wall.record(tick.figure_now() - arrived.arrival);
  if (progress_) progress_(arrived.scan.valid.end, ++count_);
}

MappingTask::MappingTask(MotionChannel& motions, Robot& robot, Monitor& monitor)
    : motions_(motions), robot_(robot), monitor_(monitor), latency_(monitor.stage("packet_to_map")) {}

void MappingTask::tick(Tick& tick) {
  while (const ArrivedMotion* motion = motions_.take(tick)) {
    if (const auto extended = robot_.extend_map(motion->scan); !extended)
      monitor_.event(motion->scan.stamp, "mapping", to_string(extended.error()));
    if (tick.takes_time()) latency_.wall.record(tick.figure_now() - motion->arrival);
    if (tick.regime() != Regime::kDrain) break;
  }
  motions_.give_back(tick);
}

}  // namespace cairn
