// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/local_map/subsample.hpp"

namespace cairn::odometry {

/// A scan as it was placed: enough to see its surroundings again.
struct PlacedScan {
  Time stamp{};
  SE3 T_odom_base;
  std::vector<Eigen::Vector3f> points_base;  ///< deskewed, thinned, in base_link at `stamp`, in metres
};

/// Chooses the scans that are kept for a restart: the first ones, until the surroundings are dense,
/// then one per stretch of way or turn.
class ScanSelection {
 public:
  ScanSelection() = default;
  /// Of a run that goes on where the surroundings are dense already.
  explicit ScanSelection(const SE3& T_odom_last) : T_odom_last_(T_odom_last), taken_(kFirst) {}

  [[nodiscard]] bool wants(const SE3& T_odom_base) const;
  void take(const SE3& T_odom_base);

 private:
  static constexpr int kFirst = 8;                            // 0.8 s at 10 Hz; chosen by hand
  static constexpr double kStretch_m = 0.4, kTurn_rad = 0.2;  // about an epoch of DriftHistory
  SE3 T_odom_last_;
  int taken_ = 0;
};

/// Thins a scan as odometry does before it learns from it. Keeps its memory between calls.
class ScanThinning {
 public:
  explicit ScanThinning(const OdometryConfig& config)
      : edge_m_(config.insert_spacing_m), range_m_(config.max_range_m) {}
  /// `out` gets what is left of the points, in their order.
  void operator()(std::span<const Eigen::Vector3f> points_base, std::vector<Eigen::Vector3f>& out);

 private:
  double edge_m_, range_m_;
  Subsample subsample_;
  std::vector<std::uint32_t> near_;
};

/// The scans of the last metres of the way. They tell odometry its surroundings after a restart.
class RecentScans {
 public:
  static constexpr std::size_t kScans = 40;  ///< 16 m of way at 0.4 m each

  /// Drops the oldest when there are more than kScans.
  void add(PlacedScan scan);
  /// In the order of their stamps.
  [[nodiscard]] const std::deque<PlacedScan>& scans() const { return scans_; }

 private:
  std::deque<PlacedScan> scans_;
};

}  // namespace cairn::odometry
