// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "hal/monitor.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/streams/stream_outlets.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/app/tasks/wheel_history.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Scan in, pose out, one in a tick.
class OdometryTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedScan> scans{*this, "scans"};
  const std::size_t steps_slot = take_slots();  ///< iterations granted
  scheduler::OutputPort<ArrivedMotion> motions{*this, "motions"};
  scheduler::OutputPort<OdometryNews> status{*this, "status"};
  scheduler::InputPort<DriveState> wheels{*this, "wheels"};

  using Progress = std::function<void(Time, std::size_t scans)>;

  /// All must outlive the task. `progress` is called after every scan, on the task's thread; may be empty.
  OdometryTask(const RobotProfile& profile, Robot& robot, Monitor& monitor, Progress progress);

  /// Live: every pose is written to `pose`, too. To be called before the run; `pose` must outlive the task.
  void publish_to(LatestValue<TrackPoint>& pose) { published_ = &pose; }
  /// Live: every pose goes to `outlets`, too, and scans while they are wanted. What finds no room is left out. To be
  /// called before the run; `outlets` must outlive the task.
  void serve(StreamOutlets& outlets) { outlets_ = &outlets; }

  void tick(scheduler::Tick& tick) override;

 private:
  void locate(const ArrivedScan& arrived, scheduler::Tick& tick);
  void publish_status(scheduler::Tick& tick);
  void hand_to_clients(const TrackPoint& point, const LocatedScan& scan);

  Duration deadline_;
  int max_steps_;
  WheelHistory history_;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
  Progress progress_;
  LatestValue<TrackPoint>* published_ = nullptr;
  StreamOutlets* outlets_ = nullptr;
  LocatedScan dropped_;  // filled when the channel is full
  std::size_t count_ = 0;
  bool lost_ = false, published_lost_ = false;
};

}  // namespace cairn::app
