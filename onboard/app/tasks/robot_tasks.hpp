// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <span>

#include "hal/workers.hpp"
#include "onboard/app/perception/mount_task.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/app/rejoin/rejoin_task.hpp"
#include "onboard/app/restart/restart.hpp"
#include "onboard/app/sight/open_sight.hpp"
#include "onboard/app/tasks/depth_task.hpp"
#include "onboard/app/tasks/detection_task.hpp"
#include "onboard/app/tasks/drive_task.hpp"
#include "onboard/app/tasks/mapping_task.hpp"
#include "onboard/app/tasks/odometry_task.hpp"
#include "onboard/app/tasks/perception_task.hpp"
#include "onboard/app/tasks/receive_task.hpp"
#include "onboard/app/tasks/safety_task.hpp"
#include "onboard/app/tasks/stereo_task.hpp"
#include "onboard/app/tasks/visual_odometry_task.hpp"
#include "onboard/app/team/team_tasks.hpp"
#include "onboard/scheduler/idle_task.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::app {

/// The tasks of one robot and the graph that connects them. What a live run adds (recording, saving, publishing) is
/// not in it; see LiveRun.
class RobotTasks {
 public:
  /// `sources`: what the robot reads from; with peers among them, the robot takes part in its team. `sight`: what looks
  /// at pictures, or off. All others must outlive the tasks.
  RobotTasks(std::span<const recording::SourceEntry> sources, const RobotProfile& profile, const RunOptions& options,
             const PreviousRun& previous, Sight sight, Monitor& monitor);
  RobotTasks(const RobotTasks&) = delete;
  RobotTasks& operator=(const RobotTasks&) = delete;
  ~RobotTasks() = default;

  const safety::Fitted fitted;
  Workers odometry_workers, mapping_workers;
  Robot robot;
  SafetyTask safety;
  DriveTask drive;
  ReceiveTask receive;
  MappingTask mapping;
  RejoinTask rejoin;
  scheduler::IdleTask reference;  ///< as often as the control task
  scheduler::TaskGraph graph;
  std::optional<OdometryTask> odometry;      ///< none: both eyes tell the motion
  std::optional<VisualOdometryTask> visual;  ///< none: a LiDAR tells the motion
  std::optional<StereoTask> stereo;          ///< with `visual`
  std::optional<PerceptionTask> perception;  ///< none: nothing is labelled
  std::deque<DetectionTask> detections;      ///< one for each camera that looks for people
  std::optional<MountTask> mounts;           ///< none: no camera's mount is watched
  std::optional<DepthTask> depth;            ///< none: no depth camera, or the map gets no clouds
  std::optional<TeamTasks> team;             ///< none: this robot takes part in no team

  /// Every pose is told to `pose`; see PoseTeller.
  void publish_poses_to(LatestValue<TrackPoint>& pose);
  /// Poses and located scans are told to `outlets`; see PoseTeller.
  void serve_poses(StreamOutlets& outlets);
  /// Scans that came whole, or stereo pictures that were looked at. Any thread.
  [[nodiscard]] std::uint64_t looks() const;

 private:
  void add_inputs(const ScheduleProfile& schedule);
  void add_odometry(const RobotProfile& profile, const RunOptions& options, Monitor& monitor);
  void add_eyes(StereoEyes eyes, const RobotProfile& profile, const RunOptions& options, Monitor& monitor);
  void connect_safety(const ScheduleProfile& schedule);
  void connect_map(const ScheduleProfile& schedule, bool live);
  void add_rejoin(const ScheduleProfile& schedule);
  void add_depth(const RobotProfile& profile, bool live, Monitor& monitor);
  void add_detection(DetectionParts parts, const ScheduleProfile& schedule, bool live, Monitor& monitor);
  void add_mounts(std::vector<MountParts> eyes, const ScheduleProfile& schedule, bool live, Monitor& monitor);
  void add_perception(Perception sight, const ScheduleProfile& schedule, bool live, Monitor& monitor);
};

}  // namespace cairn::app
