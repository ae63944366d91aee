// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "drivers/camera/camera.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/alignment/depth_edges.hpp"
#include "onboard/perception/labelling/located_scans.hpp"
#include "tools/cli/projection/odometry_player.hpp"

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
  /// Packets that could not be read or decoded.
  [[nodiscard]] std::size_t unreadable() const { return unreadable_ + player_->unreadable(); }
  /// See OdometryPlayer.
  [[nodiscard]] std::size_t scans_without_pose() const { return player_->scans_without_pose(); }

 private:
  using Use = std::function<Result<void>(const PicturePair&)>;
  /// The edges of one scan.
  struct ScanEdges {
    Time stamp{};
    std::vector<alignment::DepthEdge> edges;
  };

  PairedPictures(const app::RobotProfile& profile, std::unique_ptr<OdometryPlayer> player, camera::Camera camera);
  void take_scan(const Scan& scan, const odometry::OdometryUpdate& motion, std::uint32_t epoch);
  void take_picture(const Packet& packet, int every);
  [[nodiscard]] Result<void> serve(bool all, const Use& use);
  [[nodiscard]] Result<void> serve_one(const Image& picture, const Use& use);

  std::unique_ptr<OdometryPlayer> player_;
  SE3 T_base_lidar_;
  bool side_by_side_;
  camera::Camera camera_;
  alignment::DepthEdgeFinder finder_;
  labelling::LocatedScans scans_;
  std::deque<ScanEdges> edges_;
  std::deque<Image> waiting_;
  Duration half_sweep_{};
  std::size_t decoded_ = 0, pictures_ = 0, without_scan_ = 0, unreadable_ = 0;
};

}  // namespace cairn::cli
