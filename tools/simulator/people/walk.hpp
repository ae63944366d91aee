// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/simulator/motion/path.hpp"
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {

/// Somebody on the way. All walkers of a crowd advance together, step by step.
class Walker {
 public:
  /// Starts near where `robots[number % robots]` starts, at a place where there is room. Stands for `pause` wherever
  /// the way ends, and gives way meanwhile.
  Walker(const FloorPlan& plan, std::span<const Trajectory> robots, std::uint64_t number, double height, Duration pause,
         std::uint64_t seed);

  [[nodiscard]] const Stride& stride() const { return stride_; }
  [[nodiscard]] double pace() const { return pace_; }  ///< m/s, where nothing is in the way

  /// One step of `dt` seconds from time `t`; `others` are the places of all walkers, this one's at `self`.
  void step(Time t, double dt, std::span<const Eigen::Vector2d> others, std::size_t self);

 private:
  void choose_goal(Time t);
  void stand(Time t);
  [[nodiscard]] Eigen::Vector2d ahead();
  [[nodiscard]] Eigen::Vector2d wish(Time t, std::span<const Eigen::Vector2d> others, std::size_t self);
  void turn(double dt);

  const FloorPlan& plan_;
  std::span<const Trajectory> robots_;
  std::size_t robot_;
  double height_, pace_;
  Duration pause_;
  Random random_;
  Stride stride_;
  Path path_;
  std::size_t next_ = 0;
  Time patience_{};  // another goal is chosen then
};

}  // namespace cairn::simulator
