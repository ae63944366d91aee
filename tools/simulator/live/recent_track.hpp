// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tools/simulator/motion/track.hpp"

namespace cairn::simulator {

/// A track that grows while the robot is driven. It keeps the last second.
class RecentTrack final : public Track {
 public:
  static constexpr Duration kStep = std::chrono::milliseconds(1);  ///< between two poses; between them it is a line
  static constexpr std::size_t kKept = 1000;                       ///< poses

  /// `pose`: x y z roll pitch yaw, as Trajectory has them.
  RecentTrack(Time start, const Vector6& pose) : start_(start) { poses_[0] = pose; }

  /// The pose at end() + kStep, without a jump of an angle.
  void append(const Vector6& pose) { poses_[++last_ % kKept] = pose; }

  [[nodiscard]] Time start() const override { return start_; }
  [[nodiscard]] Time end() const { return start_ + kStep * static_cast<std::int64_t>(last_); }
  [[nodiscard]] const Vector6& newest() const { return poses_[last_ % kKept]; }

  /// The oldest pose that is kept for what is before it, and the newest for what is after it.
  [[nodiscard]] SE3 T_world_base(Time t) const override;

 private:
  Time start_;
  std::uint64_t last_ = 0;  // number of the newest pose
  std::array<Vector6, kKept> poses_{};
};

}  // namespace cairn::simulator
