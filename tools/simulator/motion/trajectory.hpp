// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/simulator/motion/track.hpp"

namespace cairn::simulator {

/// Where base_link truly was: knots every kKnotPeriod, between them a Catmull–Rom spline in x, y, z, roll, pitch, yaw,
/// so position and velocity are continuous. The knots are exact.
class Trajectory final : public Track {
 public:
  static constexpr Duration kKnotPeriod = std::chrono::milliseconds(10);

  /// `knots`: x y z roll pitch yaw in the world, fixed axes, angles without jumps; at least one.
  Trajectory(Time start, std::vector<Vector6> knots) : start_(start), knots_(std::move(knots)) {}

  [[nodiscard]] Time start() const override { return start_; }
  [[nodiscard]] Time end() const { return start_ + kKnotPeriod * static_cast<std::int64_t>(knots_.size() - 1); }
  [[nodiscard]] const std::vector<Vector6>& knots() const { return knots_; }
  [[nodiscard]] Time knot_time(std::size_t i) const { return start_ + kKnotPeriod * static_cast<std::int64_t>(i); }

  /// Before the start and after the end the robot rests at the first and last knot.
  [[nodiscard]] Vector6 xyz_rpy(Time t) const;
  [[nodiscard]] SE3 T_world_base(Time t) const override { return SE3::from_xyz_rpy(xyz_rpy(t)); }

  /// Length of the path through the knots, metres.
  [[nodiscard]] double length() const;

 private:
  Time start_;
  std::vector<Vector6> knots_;
};

}  // namespace cairn::simulator
