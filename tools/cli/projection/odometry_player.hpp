// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "drivers/recording/recording_reader.hpp"
#include "hal/monitor.hpp"
#include "hal/workers.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/odometry/odometry.hpp"

namespace cairn::cli {

/// Plays a recording: its LiDAR through the odometry, and the packets of one other sensor as they are.
class OdometryPlayer {
 public:
  /// `kind`: of the other sensor. Errors: those of the recording; kNotFound where it has none such or no LiDAR.
  [[nodiscard]] static Result<std::unique_ptr<OdometryPlayer>> open(const std::filesystem::path& recording,
                                                                    const app::RobotProfile& profile,
                                                                    recording::SensorKind kind);

  /// What is done with the recording's parts, in their order.
  struct Use {
    std::function<void(const Packet&)> packet;  ///< of the other sensor
    /// A scan with its pose. `epoch` counts maps.
    std::function<void(const Scan&, const odometry::OdometryUpdate&, std::uint32_t epoch)> scan;
    std::function<Result<void>()> after;  ///< after each of those; its first error ends the play
  };
  [[nodiscard]] Result<void> play(const Use& use);

  [[nodiscard]] std::size_t unreadable() const { return unreadable_; }  ///< parts that could not be read
  /// Scans whose pose the odometry could not find; it has the LiDAR alone, no wheels.
  [[nodiscard]] std::size_t scans_without_pose() const { return scans_without_pose_; }

 private:
  OdometryPlayer(const app::RobotProfile& profile, std::unique_ptr<recording::RecordingReader> reader);
  void take_scan(const Scan& scan, const Use& use);
  Result<void> take(const Packet& packet, const Use& use);

  std::unique_ptr<recording::RecordingReader> reader_;
  Monitor monitor_;
  Workers workers_;
  int most_steps_;
  std::unique_ptr<ScanDecoder> lidar_;
  SourceId lidar_id_{}, other_id_{};
  odometry::LidarOdometry odometry_;
  std::uint32_t epoch_ = 0;
  std::size_t unreadable_ = 0, scans_without_pose_ = 0;
};

}  // namespace cairn::cli
