// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "hal/monitor.hpp"
#include "onboard/app/robot_profile.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn {

/// Scan in, pose out, one in a tick. Slots: 0 scans taken, 1 iterations granted, 2 located scans accepted.
class OdometryTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kScansSlot = 0, kStepsSlot = 1, kMotionsSlot = 2;
  using Progress = std::function<void(Time, std::size_t scans)>;

  /// All must outlive the task. `progress` is called after every scan, on the task's thread; may be empty.
  OdometryTask(const RobotProfile& profile, ScanChannel& scans, MotionChannel& motions, Robot& robot, Monitor& monitor,
               Progress progress);

  void tick(scheduler::Tick& tick) override;

 private:
  void locate(const ArrivedScan& arrived, scheduler::Tick& tick);

  Duration deadline_;
  int max_iterations_;
  ScanChannel& scans_;
  MotionChannel& motions_;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
  Progress progress_;
  LocatedScan dropped_;  // filled when the channel is full
  std::size_t count_ = 0;
};

/// Located scans in, map out, one in a tick. Slots: 0 located scans taken, 1 how much is shed.
class MappingTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kMotionsSlot = 0, kShedSlot = 1;

  /// All must outlive the task.
  MappingTask(MotionChannel& motions, Robot& robot, Monitor& monitor);

  void tick(scheduler::Tick& tick) override;

 private:
  MotionChannel& motions_;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
};

}  // namespace cairn
