// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/monitor.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/mapping/tree/position_figures.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "onboard/report/figures/trajectory_error.hpp"
#include "onboard/report/pictures/map_picture.hpp"
#include "onboard/scheduler/task_spec.hpp"
#include "onboard/scheduler/task_stats.hpp"

namespace cairn::report {

/// An estimated pose. The covariance is that of the right perturbation of T_odom_base (hal/se3.hpp),
/// accumulated since the first pose; zero if the estimate claims none.
struct PoseEstimate {
  Time stamp{};
  UncertainPose T_odom_base;
};

/// Ticks of the safety task. None in virtual time, in which ticks take no time.
struct TickStats {
  std::uint64_t count = 0;
  std::optional<std::uint64_t> missed;
  std::optional<Duration> max_lateness;
};

/// One fixed-rate task of the run.
struct TaskFigures {
  scheduler::TaskSpec spec;
  scheduler::TaskStats stats;
};

/// Totals of odometry over a run.
struct OdometryStats {
  std::uint64_t degenerate_scans = 0;     ///< some direction was not observable
  std::uint64_t wheel_scans = 0;          ///< of these, along which wheels told the motion
  std::uint64_t wheels_wrong_scans = 0;   ///< at which wheels were not believed: their scale is far off
  double wrong_wheel_scale = 0;           ///< metres for each metre of the wheels at the last of them; 0: none
  std::uint64_t lost_scans = 0;           ///< registration refused; the motion was predicted
  double lost_s = 0;                      ///< from the scan before each of them
  std::optional<double> mean_iterations;  ///< none without a pose
};

/// What became of the pictures of the colour camera.
struct LabelStats {
  std::uint64_t images = 0;              ///< whose labels reached the map
  std::uint64_t points = 0, voxels = 0;  ///< labelled in them; voxels once for each picture
  std::optional<double> latency_p99_ms;  ///< from the exposure to the map; none in virtual time
  std::uint64_t passed = 0;              ///< pictures that were not looked at, because of the rate
  std::uint64_t shed = 0;                ///< because of overload
  std::uint64_t refused = 0;             ///< that could not be labelled
  std::uint64_t apart = 0;               ///< that were labelled, but had no scans around them
};

/// What became of the stereo pictures of a robot whose motion both eyes tell.
struct VisualStats {
  std::uint64_t frames = 0;   ///< that were looked at
  std::uint64_t tracked = 0;  ///< of these, those that told the motion
  std::uint64_t lost = 0;     ///< of these, the others
  std::uint64_t refused = 0;  ///< not looked at: damaged, of another size, or the same again and again
  std::uint64_t clouds = 0;   ///< of these, those whose points went to the map
  std::uint64_t points = 0;   ///< in them
};

/// What became of the pictures of the depth camera.
struct DepthStats {
  std::uint64_t images = 0, points = 0;  ///< that are in the map
  std::uint64_t passed = 0;              ///< not looked at, because of the rate
  std::uint64_t refused = 0;             ///< that were no depth pictures
  std::uint64_t apart = 0;               ///< that had no scans around them
};

/// What became of the pictures in which a detector looks for people.
struct DetectorStats {
  std::uint64_t images = 0;          ///< looked at
  std::uint64_t detections = 0;      ///< boxes of people in them
  std::uint64_t passed = 0;          ///< pictures that were not looked at, because of the rate
  std::uint64_t shed = 0;            ///< because of overload
  std::uint64_t refused = 0;         ///< on which nothing could be seen, or of which nothing is recorded
  std::uint64_t correcting = 0;      ///< because the camera corrected its flat field
  std::optional<double> offset_deg;  ///< of the boxes from the people, to the right; none: too few of the last minute
};

/// The people of a run that followed them.
struct PeopleStats {
  std::uint64_t tracks = 0;                       ///< different people, as far as the robot can tell
  std::optional<DetectorStats> visible, thermal;  ///< none: there is no such detector
  std::uint64_t apart = 0;                        ///< pictures that had no scans around them
  std::uint64_t most_at_once = 0;
  std::optional<double> nearest_m;                    ///< how near anybody ever was; none: there was nobody
  std::vector<std::vector<Eigen::Vector2d>> paths{};  ///< where they went, odom, m; see kMostPaths
  static constexpr std::size_t kMostPaths = 500;      ///< of more people, those who were followed longest
};

/// How a camera stands to its mount, by what its pictures showed while the robot moved.
struct MountStats {
  std::string camera;         ///< id of the source
  std::string kind;           ///< "colour" or "thermal"
  std::uint64_t images = 0;   ///< looked at
  std::uint64_t pairs = 0;    ///< of these, that were compared with an earlier one
  std::uint64_t passed = 0;   ///< not looked at, because of the rate
  std::uint64_t shed = 0;     ///< because of overload
  std::uint64_t refused = 0;  ///< on which nothing could be seen, or without scans around them
  /// Roll, pitch and yaw of the camera beside its mount, and their standard deviations, in the last 12 s.
  /// None: the robot moved too little.
  std::optional<Eigen::Vector3d> turn_deg{}, deviation_deg{};
  bool moved = false;  ///< an axis was turned too far to be chance
};

/// One robot of the team, as this one saw it.
struct PeerStats {
  std::uint64_t tx_bytes = 0, rx_bytes = 0, tiles = 0;
  std::optional<double> age_p99_s;          ///< of its tiles; none where no tile came
  std::optional<UncertainPose> T_map_peer;  ///< none where it is not known
  bool accepted = false;
  std::string state;                     ///< why it is accepted or not, as a word that scripts may rely on: "no_link"
  std::string reason;                    ///< the same for people, with figures
  bool deployment_contradicted = false;  ///< the deployments of the two do not fit to their maps
  std::uint64_t people_tx_bytes = 0;     ///< of tx_bytes, those of places of robot and people; with all overhead
};

/// The team's map, as this robot has it.
struct TeamStats {
  std::uint64_t id = 0, anchor = 0;          ///< this robot's; the one whose first odom frame is the team's
  std::map<std::uint64_t, SE3> T_team_odom;  ///< of the robots that are in it, by now
  std::vector<std::string> merged_with;      ///< their names, without this one's
  std::uint64_t tiles = 0;                   ///< that this robot said
  std::uint64_t held_back_times = 0;         ///< that it said nothing of its map, because that was in doubt
  double held_back_s = 0;                    ///< so long, all together
  std::uint64_t held_back_tiles = 0;         ///< that scans contradicted, and that were not said
  std::uint64_t satellite_fixes = 0;         ///< that came in, where the profile uses them
  std::optional<UncertainPose> T_site_odom;  ///< by satellites
  /// How well places of voxels are known; none before a teammate is merged.
  std::optional<mapping::PositionFigures> positions;
  std::string sha256;  ///< over team.cairn and team.tum: the same on every robot of the team
};

/// The content of report.json and report.html. The run fills it in, and write_report() writes it. A figure that was not
/// measured is none, never zero.
struct RunReport {
  std::string robot, profile;
  std::string source;   ///< the recording, or "live"
  bool live = false;    ///< devices, not a recording
  std::string version;  ///< of the program
  std::string started;  ///< UTC of the first packet as ISO 8601; metadata only. Empty: not known

  std::string lost_schedule;  ///< live: why schedule.log is not complete; empty: it is
  bool interrupted = false;   ///< asked to end before the recording's end: all is of the part that was played
  bool incomplete = false;    ///< maps and what comes with them are not written yet, or could not be

  std::optional<double> distance_m;  ///< length of the estimated trajectory; none without a pose
  std::optional<double> duration_s;  ///< on the robot's time line; none without a packet
  std::uint64_t scans = 0;
  /// Of the LiDAR, by the gaps in its data. None without a scan, and where scans were not recorded as packets.
  std::optional<std::uint64_t> lost_packets;
  /// Live: what each device counted as lost or doubtful, by the device's id: "lidar", {"kernel_drops", 3}.
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::uint64_t>>>> losses;
  std::uint64_t missing_packets = 0;  ///< a replay of a live run: packets that it had and the recording lacks
  bool wheels_unread = false;         ///< there is a drive, but its wheels could not be read
  TickStats ticks;                    ///< of the control task
  std::vector<TaskFigures> tasks;
  std::string mode;                                         ///< at the end
  std::string mode_cause;                                   ///< the fault's code; empty: none
  std::vector<std::pair<std::string, std::uint64_t>> shed;  ///< scans at each level of shedding, `nothing` first
  std::optional<LabelStats> labels;                         ///< of a run that looked at pictures
  std::optional<VisualStats> visual_odometry;               ///< of a robot whose motion both eyes tell
  std::optional<DepthStats> depth;                          ///< of a run whose map got clouds
  std::optional<PeopleStats> people;                        ///< of a run that followed people
  std::vector<MountStats> mounts;                           ///< of the cameras whose mounts were watched
  OdometryStats odometry;
  double peak_rss_mb = 0;
  std::optional<std::uint64_t> control_thread_allocations;  ///< after the warm-up; none without ticks after it

  const Monitor* monitor = nullptr;  ///< stages and events; not owned, may be null, must outlive the report
  Time start{};                      ///< events and series are shown relative to this
  std::vector<PoseEstimate> trajectory;
  std::vector<StampedPose> ground_truth;  ///< T_world_base; empty where there is none

  MapSummary map;
  /// Files of maps whose place in `map` is not known, the oldest first; and how many more were not kept.
  std::vector<std::string> earlier_maps;
  std::size_t dropped_maps = 0;
  /// Files of maps that are parts of `map` by now, the oldest first, and T_map_earlier.
  std::vector<std::pair<std::string, SE3>> joined_maps;
  std::uint64_t cleared_voxels = 0;  ///< of the map: something had come into free space there, and went
  std::optional<std::uint64_t> map_file_bytes;
  std::optional<MapPicture> picture;  ///< from above

  std::map<std::string, PeerStats> peers;
  std::optional<TeamStats> team;  ///< of a robot that took part in one
  std::string effective_config;   ///< YAML
  std::string output_sha256;      ///< over the files that the run left behind
};

/// More than one call in a hundred took longer than the stage's budget.
[[nodiscard]] inline bool over_budget(const StageStats& stage) {
  return stage.budget > Duration{} && stage.wall.percentile(0.99) > stage.budget;
}

/// Highest resident set size of this process so far, in MiB (getrusage).
[[nodiscard]] double peak_rss_mb();

}  // namespace cairn::report
