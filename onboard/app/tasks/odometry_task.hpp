// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "hal/monitor.hpp"
#include "onboard/app/perception/arrived_pose.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/streams/pose_teller.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/odometry/estimation/wheel_history.hpp"
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
  scheduler::OutputPort<ArrivedPose> poses{*this, "poses"};  ///< those that scans alone tell

  using Progress = std::function<void(Time, std::size_t scans)>;

  /// All must outlive the task. `progress` is called after every scan, on the task's thread; may be empty.
  OdometryTask(const RobotProfile& profile, Robot& robot, Monitor& monitor, Progress progress);

  /// Live: who is told every pose and every located scan.
  [[nodiscard]] PoseTeller& teller() { return teller_; }

  void tick(scheduler::Tick& tick) override;

 private:
  void locate(const ArrivedScan& arrived, scheduler::Tick& tick);
  void publish_pose(const TrackPoint& point, scheduler::Tick& tick);
  void publish_status(scheduler::Tick& tick);
  void watch_wheels(const TrackPoint& point);

  Duration deadline_;
  int max_steps_;
  odometry::WheelHistory history_;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
  Progress progress_;
  PoseTeller teller_;
  LocatedScan dropped_;  // filled when the channel is full
  std::size_t count_ = 0;
  bool lost_ = false, published_lost_ = false;
  bool wheels_wrong_ = false;  // and that was said
};

}  // namespace cairn::app
