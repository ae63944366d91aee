// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/tasks/safety_task.hpp"

namespace cairn::test {

/// The far ends of the safety task's ports, for a test that stands for all other tasks.
class SafetyNeighbours final : public scheduler::Task {
 public:
  void tick(scheduler::Tick& /*tick*/) override {}
  /// Another task may follow; what waits in the channels goes to it.
  void connect(app::SafetyTask& task) {
    join(sensors, task.sensors, sensors_channel_);
    join(drive, task.drive, drive_channel_);
    join(task.decisions, decisions, decisions_channel_);
    join(odometry, task.odometry, odometry_channel_);
    join(rearms, task.rearms, rearms_channel_);
    join(task.lines, lines, lines_channel_);
  }

  scheduler::OutputPort<app::SensorsSeen> sensors{*this, "sensors"};
  scheduler::OutputPort<app::DriveNews> drive{*this, "drive"};
  scheduler::InputPort<safety::FailsafeDecision> decisions{*this, "decisions"};
  scheduler::OutputPort<app::OdometryNews> odometry{*this, "odometry"};
  scheduler::OutputPort<app::RearmRequest> rearms{*this, "rearms"};
  scheduler::InputPort<app::LineEdge> lines{*this, "lines"};

 private:
  template <class T>
  static void join(scheduler::OutputPort<T>& from, scheduler::InputPort<T>& to, scheduler::Channel<T>& channel) {
    from.connect(channel);
    to.connect(channel);
  }

  scheduler::Progress nobody_;
  scheduler::Channel<app::SensorsSeen> sensors_channel_{{.capacity = 8}, nobody_, nobody_};
  scheduler::Channel<app::DriveNews> drive_channel_{{.capacity = 8}, nobody_, nobody_};
  scheduler::Channel<safety::FailsafeDecision> decisions_channel_{{.capacity = 8}, nobody_, nobody_};
  scheduler::Channel<app::OdometryNews> odometry_channel_{{.capacity = 8}, nobody_, nobody_};
  scheduler::Channel<app::RearmRequest> rearms_channel_{{.capacity = 8}, nobody_, nobody_};
  scheduler::Channel<app::LineEdge> lines_channel_{{.capacity = 8}, nobody_, nobody_};
};

}  // namespace cairn::test
