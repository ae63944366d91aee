// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace cairn::visual_odometry {

/// How a patch lies in a picture: what is at x from its middle is at `middle` + `warp` x. Pixels.
struct PatchPose {
  Eigen::Vector2f middle = Eigen::Vector2f::Zero();
  Eigen::Matrix2f warp = Eigen::Matrix2f::Identity();
};

/// How the surroundings of a corner looked once, and how to find them again: they may be warped, brighter or darker.
///
/// Following a corner from picture to picture adds an error each time. A patch of the first picture does not drift.
/// Inverse compositional steps with gain and offset (Baker, Matthews, "Lucas–Kanade 20 years on", 2004): the gradient
/// of the patch serves all steps and all pictures.
class Patch {
 public:
  static constexpr int kReach = 6;  ///< pixels from the middle to the edge
  static constexpr int kEdge = 2 * kReach + 1;
  static constexpr int kPixels = kEdge * kEdge;

  /// The patch around `middle`. None where the picture ends, or where nothing tells how a patch lies. `picture`: 8
  /// bits.
  [[nodiscard]] static std::optional<Patch> cut(const cv::Mat& picture, const Eigen::Vector2f& middle);

  /// Where `picture` shows it. None where it does not look alike, or lies far from `start`.
  [[nodiscard]] std::optional<PatchPose> find(const cv::Mat& picture, const PatchPose& start) const;

 private:
  static constexpr int kNumbers = 8;  // warp by rows (4), middle (2), gain, offset
  using Numbers = Eigen::Matrix<float, kNumbers, 1>;
  using Values = Eigen::Matrix<float, kPixels, 1>;

  [[nodiscard]] static bool sample(const cv::Mat& picture, const PatchPose& pose, Values& values);
  [[nodiscard]] Numbers step(const Values& seen) const;
  [[nodiscard]] bool looks_like(const Values& seen) const;

  Values value_;                                          // without their mean
  Eigen::Matrix<float, kNumbers, kPixels> derivative_;    // of each pixel
  Eigen::Matrix<float, kNumbers, kNumbers> uncertainty_;  // inverse of the steps' normal equations
};

}  // namespace cairn::visual_odometry
