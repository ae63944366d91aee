// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/odometry_task.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

OdometryTask::OdometryTask(const RobotProfile& profile, Robot& robot, Monitor& monitor, Progress progress)
    : deadline_(from_seconds(profile.odometry_deadline_s)),
      max_steps_(odometry::most_steps(profile.odometry)),
      robot_(robot),
      monitor_(monitor),
      latency_(monitor.stage("packet_to_pose")),
      progress_(std::move(progress)) {}

void OdometryTask::tick(Tick& tick) {
  while (const DriveState* state = wheels.take(tick)) history_.add(*state);
  while (const ArrivedScan* arrived = scans.take(tick)) {
    locate(*arrived, tick);
    if (tick.regime() != Regime::kDrain) break;
  }
  scans.give_back(tick);
  publish_status(tick);
}

void OdometryTask::locate(const ArrivedScan& arrived, Tick& tick) {
  ArrivedMotion* out = motions.back(tick);
  const Time deadline = robot_.resuming() ? Time::max() : arrived.scan.valid.end + deadline_;
  Budget budget = tick.budget(steps_slot, deadline, max_steps_);
  const auto rolled = history_.at(arrived.scan.valid.end);
  const auto located =
      robot_.locate(arrived.scan, budget, out != nullptr ? out->scan : dropped_, rolled ? &*rolled : nullptr);
  tick.settle(steps_slot, budget);
  if (located) {
    teller_.tell(*located, robot_);
    teller_.tell(out != nullptr ? out->scan : dropped_);
  }
  lost_ = !located || located->lost;
  if (located) watch_wheels(*located);
  if (!lost_ && located->degenerate_directions == 0) publish_pose(*located, tick);
  if (!located) {
    monitor_.event(arrived.scan.valid.end, "odometry", to_string(located.error()));
  } else if (out == nullptr) {
    monitor_.event(arrived.scan.valid.end, "odometry", "a scan did not get into the map: mapping is behind");
  } else {
    out->arrival = arrived.arrival;
    motions.push(tick);
  }
  if (tick.takes_time()) latency_.record(tick.figure_now() - arrived.arrival);
  if (progress_) progress_(arrived.scan.valid.end, ++count_);
}

void OdometryTask::watch_wheels(const TrackPoint& point) {
  const bool wrong = point.wrong_wheel_scale != 0;
  if (wrong && !std::exchange(wheels_wrong_, wrong))
    monitor_.event(point.stamp, "odometry", "the wheels are not believed: their scale is wrong by more than 15 %");
  wheels_wrong_ = wrong;
}

void OdometryTask::publish_pose(const TrackPoint& point, Tick& tick) {
  ArrivedPose* out = poses.back(tick);
  if (out == nullptr) return;
  *out = {point.stamp, point.T_odom_base.mean, point.twist, point.epoch};
  poses.push(tick);
}

/// The safety task hears of changes only.
void OdometryTask::publish_status(Tick& tick) {
  if (lost_ == published_lost_ || tick.regime() == Regime::kDrain) return;
  OdometryNews* out = status.back(tick);
  if (out == nullptr) return;  // with the next tick
  out->lost = published_lost_ = lost_;
  status.push(tick);
}

}  // namespace cairn::app
