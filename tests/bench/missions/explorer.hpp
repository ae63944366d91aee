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

/// A world with what a robot needs in order to drive in it and to see it.
struct Site {
  explicit Site(simulator::World w);

  simulator::World world;
  simulator::FloorPlan plan;
  simulator::Tracer tracer;
};

/// A robot that roams a site and maps it: every 1.5 m it stops for a scan of sixteen lasers, 2 cm of noise on each
/// range; its poses are exact. Its map's frame is turned and moved at random, and leans: a robot does not know gravity
/// exactly, and floors that lie along a grid flatter who tells heights and leans.
class Explorer {
 public:
  static constexpr double kStopM = 1.5, kRangeM = 12, kLeanDeg = 0.5;

  /// `site` must outlive it. `metres` is how far it drives, `lean_deg` by how much its frame leans at most, about a
  /// level axis; from 90 on about any.
  Explorer(const Site& site, std::uint64_t seed, double metres, double resolution_m = 0.1, double lean_deg = kLeanDeg);

  /// The next `scans` stops.
  void advance(int scans);
  [[nodiscard]] const matching::MapFeatures& features() const { return *features_; }
  [[nodiscard]] const SE3& T_map_world() const { return T_map_world_; }
  /// Where it last took a scan, in the world.
  [[nodiscard]] Eigen::Vector2d at() const { return stops_[next_ == 0 ? 0 : next_ - 1]; }
  /// From now on another map, empty and in the same frame, and the robot takes its pose to be wrong by `slip` in that
  /// frame. Gives the map until now.
  std::unique_ptr<SemanticOcTree> next_map(const SE3& slip);

 private:
  void scan_at(const Eigen::Vector2d& at);

  const Site& site_;
  std::uint64_t seed_;
  double resolution_m_;
  simulator::Path stops_;
  std::size_t next_ = 0;
  SE3 T_map_world_;
  Workers workers_;
  std::unique_ptr<Mapper> mapper_;
  std::unique_ptr<matching::MapFeatures> features_;
};

}  // namespace cairn::missions
