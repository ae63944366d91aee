// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/point_cloud.hpp"
#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/odometry/normal_equations.hpp"
#include "onboard/odometry/subsample.hpp"

namespace cairn {

/// One scan made ready: its finite points, their ages, and two thinned selections. Keeps its memory between scans.
class ScanPoints {
 public:
  struct Limits {
    float min_range_m, max_range_m;
    float dense_spacing_m;  ///< of the points for the map
    std::size_t keypoints;  ///< aimed at; twice as many is the cap
  };
  explicit ScanPoints(const Limits& limits);

  /// Takes the points of a scan whose arrays fit each other. A firing time outside the scan is clamped to it.
  void take(const Scan& scan);
  /// Moves all points to base_link at the stamp, for a base with this twist during the scan.
  std::span<const Eigen::Vector3f> deskew(const Vector6& twist, const SE3& T_base_lidar, Workers& workers);

  /// For registration. Their spacing follows from scan to scan, so that about as many as wanted come out.
  [[nodiscard]] std::span<const Keypoint> keypoints() const { return keypoints_; }
  /// Indices of the points for the map.
  [[nodiscard]] std::span<const std::uint32_t> dense() const { return dense_; }
  [[nodiscard]] std::span<const Eigen::Vector3f> points_base() const { return points_base_; }
  [[nodiscard]] std::uint8_t ring(std::size_t point) const { return ring_[point]; }
  /// Age of the oldest point; 0 when the scan came deskewed.
  [[nodiscard]] double duration_s() const { return duration_s_; }

 private:
  void clear(std::size_t points);
  void choose_keypoints();

  Limits limits_;
  std::vector<Eigen::Vector3f> points_lidar_, points_base_;
  std::vector<float> age_s_;
  std::vector<std::uint8_t> ring_;
  std::vector<std::uint32_t> in_range_;
  double duration_s_ = 0;

  Subsample thin_, thin_further_;
  std::span<const std::uint32_t> dense_;
  float keypoint_spacing_m_;
  std::vector<Keypoint> keypoints_;
};

}  // namespace cairn
