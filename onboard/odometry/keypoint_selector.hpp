// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "onboard/odometry/config.hpp"
#include "onboard/odometry/estimation/normal_equations.hpp"
#include "onboard/odometry/local_map/subsample.hpp"
#include "onboard/odometry/scan_preparation.hpp"

namespace cairn::odometry {

/// The points of a scan that are worth using. Valid until the next scan is selected from.
struct Selection {
  std::span<const std::uint32_t> for_map;  ///< indices: one point per cube of `insert_spacing_m`
  std::span<const Keypoint> keypoints;     ///< for registration: a thinner choice of the same points
  double duration_s = 0;                   ///< of the scan: no keypoint is older
};

/// Thins scans, once for the map and once more for registration. The keypoints' spacing follows
/// from scan to scan until their number is about `keypoints`; it is `2·keypoints` at most. Keeps
/// its memory between calls.
class KeypointSelector {
 public:
  explicit KeypointSelector(const OdometryConfig& config);

  [[nodiscard]] Selection select(const PreparedScan& scan);
  /// Edge of the cubes in which the next scan has one keypoint each, in metres.
  [[nodiscard]] float spacing_m() const { return spacing_m_; }

 private:
  void thin(const PreparedScan& scan, std::span<const std::uint32_t> chosen);
  void follow(std::size_t chosen);

  int wanted_;
  float map_spacing_m_;
  float spacing_m_;
  Subsample dense_, sparse_;
  std::vector<Keypoint> keypoints_;
};

}  // namespace cairn::odometry
