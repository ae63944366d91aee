// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/point_cloud.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/recent_scans.hpp"

namespace cairn::odometry {

/// A scan as odometry works on it: its finite points in the scan's order.
struct PreparedScan {
  Time stamp{};                               ///< of the scan's end
  double duration_s = 0;                      ///< no point is older; 0: all points have one age
  std::vector<Eigen::Vector3f> points_lidar;  ///< in the sensor's frame, in metres, not deskewed
  std::vector<float> age_s;                   ///< one per point: stamp − firing time, 0…duration_s
  std::vector<std::uint32_t> in_range;        ///< ascending indices of points that may be registered and mapped
};

/// Makes PreparedScans of scans. Keeps its memory between calls.
class ScanPreparation {
 public:
  /// Points per scan. An HDL-64E S3 gives 220 000 in dual return mode (data sheet: 2.2 million a
  /// second, at 10 Hz).
  static constexpr std::size_t kMaxPoints = 400'000;

  explicit ScanPreparation(const OdometryConfig& config);

  /// Errors: kLimit (more than kMaxPoints points), kMalformed (points without a firing time).
  [[nodiscard]] static Result<void> check(const Scan& scan);
  /// `scan` must have passed check(). The result is valid until the next call. Drops points that
  /// are not finite. Clamps ages to the scan's duration, and that to a slow revolution's.
  const PreparedScan& prepare(const Scan& scan);
  /// The same for a scan that was placed before: its points are deskewed, and all are in range.
  const PreparedScan& prepare(const PlacedScan& scan, const SE3& T_base_lidar);

 private:
  void clear(std::size_t points);

  float min_squared_range_m2_, max_squared_range_m2_;
  PreparedScan out_;
};

}  // namespace cairn::odometry
