// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fusion/peers/exchange.hpp"

namespace cairn::peers {

/// Submaps and the errors of odometry along them. They are those of a robot that has nothing but its scans: too large
/// rather than too small, as what they allow is what comparisons of maps may correct.
struct OwnSubmapsConfig {
  double length_m = 300;            ///< of the path through one submap
  double drift_m_per_m = 0.01;      ///< standard deviation of each axis at its end, per metre of path,
  double drift_rad_per_m = 3.5e-4;  ///< and of each turn: 0.2° in 10 m
};

/// A robot's path, cut into submaps: within one its odometry is taken to be exact, from one to the next it has drifted.
/// Submap 0 lies at the origin of odom and is never said; later ones lie where the robot was when they began, rounded
/// to whole tiles, their axes those of odom. Tiles keep their places in the grid of odom, whatever submap they are in.
class OwnSubmaps {
 public:
  static constexpr std::uint16_t kMost = 256;  ///< of one beginning; the last one has no end, and no more are read

  /// `tile_m`: edge of a tile.
  OwnSubmaps(const OwnSubmapsConfig& config, double tile_m) : config_(config), tile_m_(tile_m) {}

  /// Where the robot is, odom frame; says a submap that begins here.
  void be_at(const Eigen::Vector3d& position_odom, Exchange& exchange);
  /// The map begins anew.
  void clear() { *this = OwnSubmaps(config_, tile_m_); }
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
