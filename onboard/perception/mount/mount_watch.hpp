// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/config/config.hpp"
#include "hal/image.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/perception/mount/mount_estimator.hpp"
#include "onboard/perception/mount/picture_tracker.hpp"

namespace cairn::mount {

/// Config section `perception.mount`.
struct MountConfig {
  double rate_hz = 5;      ///< pictures that are looked at; 0: mounts are not watched
  double moved_deg = 0.6;  ///< a camera that is turned by more about one of its axes was moved
};

/// Keys, units and bounds.
void declare(config::Section& section, MountConfig& config);

/// Says whether a camera still looks where its mount says, from the pictures of a robot that moves. A picture is
/// compared with the one from where the robot was 0.2 m or 5° earlier.
class MountWatch {
 public:
  static constexpr double kLeastWay_m = 0.2, kLeastTurn_rad = 0.087;
  static constexpr Duration kOldest = std::chrono::seconds(2);  ///< between two pictures that are compared
  static constexpr double kSure_deg = 0.25;                     ///< an axis of which σ is larger is not judged
  static constexpr double kDeviations = 5;                      ///< that a turn is from 0, to be believed
  static constexpr int kConfirm = 10;                           ///< looks one after another that say so

  /// `window`: older pairs of pictures do not count.
  MountWatch(const cameras::CameraModel& camera, const SE3& T_base_camera, const MountConfig& config,
             Duration window = EstimatorConfig().window);

  /// A picture (kMono8 or kBgr8, of the camera's size) and where the robot was at its exposure. Poses of two epochs
  /// have nothing in common. False: the picture has another size.
  bool look(const Image& picture, const SE3& T_odom_base, std::uint32_t epoch);

  /// Of the window; none: the robot moved too little, or too little was seen. See MountEstimator.
  [[nodiscard]] const std::optional<MountEstimator::Estimate>& estimate() const { return estimate_; }
  /// Whether the camera was moved, by estimates of the last looks. It stays true.
  [[nodiscard]] bool moved() const { return moved_; }
  /// Pairs of pictures that were compared.
  [[nodiscard]] std::uint64_t pairs() const { return pairs_; }

 private:
  struct Reference {
    Time stamp{};
    SE3 T_odom_base;
    std::uint32_t epoch = 0;
  };
  void compare(const Image& picture, const SE3& T_before_now);
  [[nodiscard]] bool turned() const;

  cameras::CameraModel camera_;
  SE3 T_base_optical_;
  double moved_rad_;
  MountEstimator estimator_;
  PictureTracker tracker_;
  std::vector<Sighting> sightings_;  // reused
  std::optional<Reference> reference_;
  std::optional<MountEstimator::Estimate> estimate_;
  std::uint64_t pairs_ = 0;
  int confirmed_ = 0;
  bool moved_ = false;
};

}  // namespace cairn::mount
