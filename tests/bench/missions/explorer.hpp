// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "fusion/matching/features/map_features.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tools/simulator/motion/path.hpp"
#include "tools/simulator/world/floor_plan.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::missions {

/// A world, with the plan for a robot that drives in it and the tracer for one that sees it.
struct Site {
  explicit Site(simulator::World w);

  simulator::World world;
  simulator::FloorPlan plan;
  simulator::Tracer tracer;
};

/// A robot that roams a site and maps it. Every 1.5 m it stops for a scan of sixteen lasers, with 2
/// cm of noise on each range. Its poses are exact. Its map's frame is turned and moved at random,
/// and leans. A robot does not know gravity exactly, and errors in height are too small for floors
/// that lie along a grid.
class Explorer {
 public:
  static constexpr double kStop_m = 1.5;    ///< between two scans
  static constexpr double kRange_m = 12;    ///< of what is mapped
  static constexpr double kLean_deg = 0.5;  ///< of the map's frame, at most

  /// `site` must outlive it. `drive_m`: how far it drives. `lean_deg`: how much its frame leans, at
  /// most, about a level axis; from 90 on about any axis.
  Explorer(const Site& site, std::uint64_t seed, double drive_m, double resolution_m = 0.1,
           double lean_deg = kLean_deg);

  /// The next `scans` stops.
  void advance(int scans);
  [[nodiscard]] const matching::MapFeatures& features() const { return *features_; }
  [[nodiscard]] const SE3& T_map_world() const { return T_map_world_; }
  /// Where it last took a scan, in the world (m).
  [[nodiscard]] Eigen::Vector2d at() const { return stops_[next_ == 0 ? 0 : next_ - 1]; }
  /// Gives the map until now and begins an empty one in the same frame. From now on the robot's
  /// pose is wrong by `slip` in that frame.
  std::unique_ptr<mapping::SemanticOcTree> next_map(const SE3& slip);

 private:
  void scan_at(const Eigen::Vector2d& at);

  const Site& site_;
  std::uint64_t seed_;
  double resolution_m_;
  simulator::Path stops_;
  std::size_t next_ = 0;
  SE3 T_map_world_;
  Workers workers_;
  std::unique_ptr<mapping::Mapper> mapper_;
  std::unique_ptr<matching::MapFeatures> features_;
};

}  // namespace cairn::missions
