// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/client/map_mirror.hpp"

namespace cairn::client {

/// What is known of a place.
enum class Occupancy : std::uint8_t { kUnknown, kFree, kOccupied };

/// What a planner may know of a place: whether something is there, who says so, and since when.
struct Place {
  Occupancy occupancy = Occupancy::kUnknown;
  bool own = false;                       ///< this robot saw it itself
  std::span<const std::uint64_t> robots;  ///< who knows it, by id; empty: this robot, which is in no team
  Time changed{};                         ///< robot time at which the newest part of its tile was seen, or came
};

/// The own and the team's map as one. **What this robot saw itself is never overruled by a peer**: the team's map only
/// fills what it has not seen. A peer may be wrong about its pose, or its map old; the own sensor is neither.
/// Pure: it looks into two mirrors, which must outlive it. Nobody may change them meanwhile.
class PlannerView {
 public:
  /// `team`: null where there is none. `T_team_odom`: where the own odom frame lies in the team's map; none: not known,
  /// and the team's map is left alone.
  PlannerView(const MapMirror& own, const MapMirror* team, const std::optional<SE3>& T_team_odom);

  /// At a point of the odom frame, m.
  [[nodiscard]] Place at(const Eigen::Vector3d& p_odom) const;
  /// The same without who and when; cheaper.
  [[nodiscard]] Occupancy occupancy(const Eigen::Vector3d& p_odom) const;
  /// The first occupied place on the way from one point to another, both in odom, looked at every half voxel. None:
  /// nothing known is in the way.
  [[nodiscard]] std::optional<Eigen::Vector3d> first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  [[nodiscard]] double resolution_m() const { return own_.map().getResolution(); }

 private:
  const MapMirror& own_;
  const MapMirror* team_;
  SE3 T_team_odom_;
};

}  // namespace cairn::client
