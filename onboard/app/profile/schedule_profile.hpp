// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/config/config.hpp"
#include "hal/monitor.hpp"
#include "onboard/scheduler/task_spec.hpp"

namespace cairn::app {

/// The tasks of a robot, in the order in which they run when they are released together. The defaults are for the NUC
/// of a Husky with a VLP-16 at 10 Hz. Odometry and mapping look for work a hundred times a second, so that a scan does
/// not wait, and find work ten times a second.
struct ScheduleProfile {
  scheduler::TaskSpec safety{.name = "safety", .rate_hz = 500, .soft_ms = 0.2, .hard_ms = 1, .priority = 80};
  scheduler::TaskSpec drive{
      .name = "drive", .rate_hz = 500, .phase_ms = 0.2, .soft_ms = 0.2, .hard_ms = 1, .priority = 75};
  scheduler::TaskSpec receive{
      .name = "receive", .rate_hz = 100, .deadline_ms = 20, .soft_ms = 1, .hard_ms = 10, .priority = 60};
  scheduler::TaskSpec odometry{.name = "odometry",
                               .rate_hz = 100,
                               .phase_ms = 1,
                               .deadline_ms = 100,
                               .soft_ms = 40,
                               .hard_ms = 80,
                               .busy_hz = 10,
                               .priority = 50};
  scheduler::TaskSpec mapping{.name = "mapping",
                              .rate_hz = 100,
                              .phase_ms = 2,
                              .deadline_ms = 100,
                              .soft_ms = 30,
                              .hard_ms = 90,
                              .busy_hz = 10};
  scheduler::TaskSpec perception{
      .name = "perception", .rate_hz = 50, .phase_ms = 4, .deadline_ms = 400, .soft_ms = 60, .busy_hz = 5, .nice = 5};
  scheduler::TaskSpec detection{
      .name = "detection", .rate_hz = 50, .phase_ms = 6, .deadline_ms = 150, .soft_ms = 50, .busy_hz = 5, .nice = 5};
  scheduler::TaskSpec thermal_detection{.name = "thermal_detection",
                                        .rate_hz = 50,
                                        .phase_ms = 7,
                                        .deadline_ms = 150,
                                        .soft_ms = 10,
                                        .busy_hz = 5,
                                        .nice = 5};
  scheduler::TaskSpec mount{.name = "mount", .rate_hz = 50, .phase_ms = 8, .deadline_ms = 400, .nice = 5};
  scheduler::TaskSpec depth{
      .name = "depth", .rate_hz = 50, .phase_ms = 5, .deadline_ms = 100, .soft_ms = 10, .busy_hz = 5, .nice = 5};
  scheduler::TaskSpec visual_odometry{.name = "visual_odometry",
                                      .rate_hz = 100,
                                      .phase_ms = 1,
                                      .deadline_ms = 60,
                                      .soft_ms = 15,
                                      .hard_ms = 60,
                                      .busy_hz = 30,
                                      .priority = 50};
  scheduler::TaskSpec stereo{
      .name = "stereo", .rate_hz = 50, .phase_ms = 5, .deadline_ms = 250, .soft_ms = 50, .busy_hz = 5};
  scheduler::TaskSpec team{.name = "team", .rate_hz = 25, .phase_ms = 3, .deadline_ms = 200, .soft_ms = 4};
  scheduler::TaskSpec matching{.name = "matching", .rate_hz = 10, .phase_ms = 6, .deadline_ms = 5000};
  scheduler::TaskSpec rejoin{.name = "rejoin", .rate_hz = 10, .phase_ms = 6.5, .deadline_ms = 2500, .nice = 5};
  scheduler::TaskSpec watch{.name = "watch", .rate_hz = 20, .phase_ms = 4, .deadline_ms = 1000, .soft_ms = 0.5};
  scheduler::TaskSpec streams{.name = "streams", .rate_hz = 400, .phase_ms = 0.6, .deadline_ms = 5};
  scheduler::TaskSpec housekeeping{
      .name = "housekeeping", .rate_hz = 20, .phase_ms = 5, .deadline_ms = 1000, .soft_ms = 1};
  scheduler::TaskSpec saving{.name = "saving", .rate_hz = 10, .phase_ms = 7, .deadline_ms = 1000, .soft_ms = 5};

  /// Tasks that not every run has.
  struct Parts {
    bool team = false, perception = false, depth = false, detection = false, thermal_detection = false;
    bool mount = false;
    bool stereo = false;  ///< both eyes tell the motion, and no LiDAR
  };
  /// All tasks that a live run may have.
  [[nodiscard]] std::vector<scheduler::TaskSpec> tasks(const Parts& parts) const;
};

void declare(config::Section& section, ScheduleProfile& profile);

/// Error kInvalidConfig: a task that stops the robot is released less than 50 times a second.
[[nodiscard]] Result<void> check(const ScheduleProfile& profile);

/// Gives the stages of a run the budgets of their tasks: execution of odometry and mapping `soft_ms`, the latencies
/// from a scan's last byte their deadline. `by_eyes`: both eyes of the camera tell the motion. To be called before the
/// tasks are made. Other stages have no budget.
void declare_stages(const ScheduleProfile& profile, bool by_eyes, Monitor& monitor);

}  // namespace cairn::app
