// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/perception/stereo/stereo_pair.hpp"
#include "onboard/visual_odometry/config.hpp"

namespace cairn::visual_odometry {

class Patch;

/// A corner that is followed from picture to picture.
struct Feature {
  std::uint32_t id = 0;
  Eigen::Vector2f left = Eigen::Vector2f::Zero();  ///< pixel in the left eye
  std::optional<float> disparity;                  ///< pixels; none where the right eye does not show it
  std::shared_ptr<const Patch> patch;              ///< how it looked at first; null where too little is to be seen
  Eigen::Matrix2f warp_left = Eigen::Matrix2f::Identity(), warp_right = warp_left;  ///< of the patch in each eye
};

/// Follows corners from picture to picture and between the eyes: pyramids of Lucas and Kanade (Bouguet, 2001), by
/// OpenCV. Then each one is put to where the picture looks as where it was seen first, in both eyes. So its error does
/// not grow as long as it is followed. The result does not depend on the number of threads.
class FeatureTracker {
 public:
  FeatureTracker(const TrackingConfig& config, const stereo::StereoGeometry& geometry);
  FeatureTracker(FeatureTracker&&) noexcept;
  FeatureTracker& operator=(FeatureTracker&&) noexcept;
  FeatureTracker(const FeatureTracker&) = delete;
  FeatureTracker& operator=(const FeatureTracker&) = delete;
  ~FeatureTracker();

  /// Where the pixel and disparity of a feature are expected now; none: as they were.
  using Expected = std::function<std::optional<Eigen::Vector3d>(const Feature&)>;

  /// Takes the next pair, and follows all features into it. Those that are not found again are dropped.
  void follow(const stereo::StereoPair& pair, const Expected& expected);
  /// Takes back the last follow(): the next one begins again where that one did.
  void reject();
  /// Drops the features for which `unwanted` is true.
  void drop(const std::function<bool(const Feature&)>& unwanted);
  /// Adds corners of the last pair where there is room.
  void add_corners();
  /// Corners of the last pair, as if none were followed.
  [[nodiscard]] std::vector<Feature> fresh_corners();
  /// Follows these features of the last pair, and no others.
  void adopt(std::vector<Feature> features) { features_ = std::move(features); }

  /// In the order of their ids.
  [[nodiscard]] std::span<const Feature> features() const { return features_; }

 private:
  struct Pictures;
  void anchor(Feature& f) const;
  [[nodiscard]] bool fits(const Feature& f, const Eigen::Vector2f& right) const;
  bool find_right(Feature& f, float disparity) const;
  void match_eyes(std::span<Feature> features, const Expected& expected) const;
  [[nodiscard]] std::vector<Feature> corners_between(std::span<const Feature> others);

  TrackingConfig config_;
  stereo::StereoGeometry geometry_;
  std::vector<Feature> features_;
  std::vector<Feature> features_before_;  // the last follow()
  std::unique_ptr<Pictures> pictures_;
  std::uint32_t next_id_ = 1;
};

}  // namespace cairn::visual_odometry
