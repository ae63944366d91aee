// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "drivers/camera/camera.hpp"
#include "drivers/recording/recording_reader.hpp"
#include "hal/monitor.hpp"
#include "hal/workers.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/odometry/odometry.hpp"
#include "onboard/perception/alignment/depth_edges.hpp"
#include "onboard/perception/labelling/located_scans.hpp"

namespace cairn::cli {

/// A picture of a recording, and the scan that was taken with it.
struct PicturePair {
  const Image& picture;                         ///< of the (left) eye
  const labelling::PlacedScan& scan;            ///< whose middle is nearest to the exposure
  std::span<const alignment::DepthEdge> edges;  ///< of that scan
  SE3 T_odom_base;                              ///< at the exposure
};

/// Plays a recording's LiDAR through the odometry and hands out each picture with its scan. One picture and a second of
/// scans are in memory at a time, and the pictures that wait for their scan.
class PairedPictures {
 public:
  /// Errors: those of the recording; kNotFound where it has no camera or no LiDAR.
  [[nodiscard]] static Result<std::unique_ptr<PairedPictures>> open(const std::filesystem::path& recording,
                                                                    const app::RobotProfile& profile);

  /// Calls `use` for every `every`-th picture. The first error of `use` ends it. What cannot be decoded is left out.
  [[nodiscard]] Result<void> for_each(int every, const std::function<Result<void>(const PicturePair&)>& use);

  [[nodiscard]] std::size_t pictures() const { return pictures_; }          ///< taken, after `every`
  [[nodiscard]] std::size_t without_scan() const { return without_scan_; }  ///< of those: no scan or pose near them
  [[nodiscard]] std::size_t unreadable() const { return unreadable_; }      ///< packets that could not be decoded
  /// Scans whose pose the odometry could not find; it has the LiDAR alone, no wheels.
  [[nodiscard]] std::size_t scans_without_pose() const { return scans_without_pose_; }

 private:
  using Use = std::function<Result<void>(const PicturePair&)>;
  /// The edges of one scan.
  struct ScanEdges {
    Time stamp{};
    std::vector<alignment::DepthEdge> edges;
  };

  PairedPictures(const app::RobotProfile& profile, std::unique_ptr<recording::RecordingReader> reader,
                 camera::Camera camera);
  void take_scan(const Scan& scan);
  void take_picture(const Packet& packet, int every);
  [[nodiscard]] Result<void> serve(bool all, const Use& use);
  [[nodiscard]] Result<void> serve_one(const Image& picture, const Use& use);

  std::unique_ptr<recording::RecordingReader> reader_;
  Monitor monitor_;
  Workers workers_;
  SE3 T_base_lidar_;
  int most_steps_;
  bool side_by_side_;
  std::unique_ptr<ScanDecoder> lidar_;
  camera::Camera camera_;
  SourceId lidar_id_{}, camera_id_{};
  odometry::LidarOdometry odometry_;
  alignment::DepthEdgeFinder finder_;
  labelling::LocatedScans scans_;
  std::deque<ScanEdges> edges_;
  std::deque<Image> waiting_;
  Duration half_sweep_{};
  std::uint32_t epoch_ = 0;
  std::size_t decoded_ = 0, pictures_ = 0, without_scan_ = 0, unreadable_ = 0, scans_without_pose_ = 0;
};

}  // namespace cairn::cli
