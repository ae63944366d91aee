// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "fusion/team/team.hpp"
#include "hal/monitor.hpp"
#include "hal/ports.hpp"
#include "hal/result.hpp"
#include "hal/workers.hpp"
#include "onboard/app/sight/open_stereo.hpp"
#include "onboard/robot.hpp"

namespace cairn::bench {

/// The recordings of a team: those in each of the folders, whose paths are joined by commas.
[[nodiscard]] std::vector<std::filesystem::path> recordings_of(const std::string& folders);

/// A robot of a team whose LiDAR or stereo camera is a simulated recording: odometry, mapping and its part in the team,
/// in virtual time.
class RecordedRobot {
 public:
  /// Errors: those of the recording's files; kNotFound without a LiDAR, stereo camera or ground truth.
  static Result<std::unique_ptr<RecordedRobot>> open(const std::filesystem::path& recording,
                                                     const team::TeamConfig& config);

  /// Takes in what the sensor sent until `now`, which counts from the recording's start.
  Result<void> advance(Time now);
  [[nodiscard]] bool ended() const { return ended_; }

  /// Errors that odometry is given on top of its own, for each metre: of the way, and rad about its z axis.
  struct Drift {
    double scale = 0, yaw_per_metre = 0;
  };
  void set_drift(const Drift& drift) { drift_ = drift; }

  /// Where the robot thinks it is, drift and all, and where it truly is.
  [[nodiscard]] SE3 T_odom_base() const;
  [[nodiscard]] SE3 T_world_base() const;
  /// Where odom lies in the world by now, by these two.
  [[nodiscard]] SE3 T_world_odom() const { return T_world_base() * T_odom_base().inverse(); }
  [[nodiscard]] const Robot& robot() const { return robot_; }
  [[nodiscard]] std::uint64_t raw_bytes() const { return raw_bytes_; }
  /// The team's map, after all that is left to be fused, as at the end of a robot's run.
  [[nodiscard]] const mapping::SemanticOcTree& finished_map();

  team::Team team;
  std::uint64_t received_bytes = 0;

 private:
  /// What a robot without a LiDAR measures its map with, and when it does so next.
  struct Eyes {
    app::StereoEyes stereo;
    Duration map_period;
    Time next{};
  };
  RecordedRobot(const RobotConfig& robot, const team::TeamConfig& config, std::optional<Eyes> eyes);
  static Result<std::unique_ptr<RecordedRobot>> create(const std::filesystem::path& dir,
                                                       const recording::Recording& recording,
                                                       const team::TeamConfig& config);
  void take_scan(const Scan& scan, Time now);
  void take_picture(Time now);
  void extend_map(Time now);
  void drift_on(const SE3& T_odom_base);

  Monitor monitor_;
  Workers workers_{1};
  Robot robot_;
  std::unique_ptr<Source> source_;
  std::unique_ptr<ScanDecoder> decoder_;  // null: of a robot without a LiDAR
  std::optional<Eyes> eyes_;
  stereo::StereoPair pair_;
  std::vector<Eigen::Vector3f> points_eye_;
  std::vector<recording::StampedPose> truth_;
  Packet packet_;
  bool pending_ = false, ended_ = false;
  Time start_{};
  std::uint64_t raw_bytes_ = 0;
  LocatedScan located_;
  Drift drift_;
  SE3 T_drift_;  // what odometry is given on top
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();
};

}  // namespace cairn::bench
