// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "fusion/peers/exchange.hpp"
#include "hal/se3.hpp"

namespace cairn::peers {

/// The length of submaps, and the errors of odometry along them that it does not know of itself. The defaults are for a
/// robot that has only its scans. Choose errors rather too large than too small: comparisons of maps may correct as
/// much as they allow.
struct OwnSubmapsConfig {
  double length_m = 300;            ///< of the path through one submap
  double drift_m_per_m = 0.01;      ///< standard deviation of each axis, per metre of path
  double drift_rad_per_m = 3.5e-4;  ///< standard deviation of each rotation, per metre of path: 0.2° in 10 m
};

/// A robot's path, cut into submaps. Odometry counts as exact within a submap, and drifts from one to the next.
/// - Submap 0 lies at the origin of odom. It is not published.
/// - A later submap lies where the robot was when it began, rounded to whole tiles. Its axes are those of odom.
/// - The covariance of a submap is what odometry's own has grown by since the one before, and in no direction less than
///   the drift of the configuration.
/// Tiles keep their places in the grid of odom, in whatever submap they are.
class OwnSubmaps {
 public:
  static constexpr std::uint16_t kMost = 256;  ///< submaps of one beginning; the last one has no end

  /// `tile_m`: edge of a tile.
  OwnSubmaps(const OwnSubmapsConfig& config, double tile_m) : config_(config), tile_m_(tile_m) {}

  /// Where the robot is; the covariance as in UncertainPose, since the robot's map began. Publishes a submap that
  /// begins here.
  void be_at(const UncertainPose& T_odom_base, Exchange& exchange);
  /// What was mapped last must not be taken for exact: another submap begins where the robot is, as unsure as after a
  /// whole one. Nothing before the robot has been anywhere.
  void cut(Exchange& exchange);
  /// The robot's map begins anew.
  void clear() { *this = OwnSubmaps(config_, tile_m_); }
  /// The submap that the robot is in.
  [[nodiscard]] std::uint16_t current() const { return current_; }

 private:
  void begin_next(const Matrix6& drift, Exchange& exchange);
  [[nodiscard]] Matrix6 expected(double path_m) const;
  [[nodiscard]] SE3 next_place() const;
  [[nodiscard]] Matrix6 grown() const;

  OwnSubmapsConfig config_;
  double tile_m_;
  std::uint16_t current_ = 0;
  std::optional<UncertainPose> begun_, last_;  // T_odom_base where the submap began, and now
  double path_m_ = 0;
};

/// What `covariance` says, and in no direction less than `floor`, which is diagonal and positive. Only `floor`, where
/// `covariance` is not finite. The ratio of the two is kMostTimes at most.
[[nodiscard]] Matrix6 at_least(const Matrix6& covariance, const Matrix6& floor);
inline constexpr double kMostTimes = 1e6;

}  // namespace cairn::peers
