// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fusion/peers/exchange.hpp"

namespace cairn::peers {

/// The length of submaps, and the errors of odometry along them. The defaults are for a robot that has only its scans.
/// Choose errors rather too large than too small: comparisons of maps may correct as much as they allow.
struct OwnSubmapsConfig {
  double length_m = 300;            ///< of the path through one submap
  double drift_m_per_m = 0.01;      ///< standard deviation of each axis, per metre of path
  double drift_rad_per_m = 3.5e-4;  ///< standard deviation of each rotation, per metre of path: 0.2° in 10 m
};

/// A robot's path, cut into submaps. Odometry counts as exact within a submap, and drifts from one to the next.
/// - Submap 0 lies at the origin of odom. It is not published.
/// - A later submap lies where the robot was when it began, rounded to whole tiles. Its axes are those of odom.
/// Tiles keep their places in the grid of odom, in whatever submap they are.
class OwnSubmaps {
 public:
  static constexpr std::uint16_t kMost = 256;  ///< submaps of one beginning; the last one has no end

  /// `tile_m`: edge of a tile.
  OwnSubmaps(const OwnSubmapsConfig& config, double tile_m) : config_(config), tile_m_(tile_m) {}

  /// Where the robot is: odom frame, metres. Publishes a submap that begins here.
  void be_at(const Eigen::Vector3d& position_odom, Exchange& exchange);
  /// The robot's map begins anew.
  void clear() { *this = OwnSubmaps(config_, tile_m_); }
  /// The submap that the robot is in.
  [[nodiscard]] std::uint16_t current() const { return current_; }

 private:
  void begin_next(Exchange& exchange);

  OwnSubmapsConfig config_;
  double tile_m_;
  std::uint16_t current_ = 0;
  bool placed_ = false;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
  double path_m_ = 0;
};

}  // namespace cairn::peers
