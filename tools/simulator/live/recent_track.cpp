// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/recent_track.hpp"

#include <algorithm>

namespace cairn::simulator {

SE3 RecentTrack::T_world_base(Time t) const {
  const std::uint64_t first = last_ < kKept ? 0 : last_ - kKept + 1;
  const Duration since = std::clamp(t, start_ + kStep * static_cast<std::int64_t>(first), end()) - start_;
  const auto n = static_cast<std::uint64_t>(since / kStep);
  const double u = static_cast<double>((since % kStep).count()) / static_cast<double>(kStep.count());
  const Vector6& from = poses_[n % kKept];
  const Vector6& to = poses_[std::min(n + 1, last_) % kKept];
  return SE3::from_xyz_rpy(from + u * (to - from));
}

}  // namespace cairn::simulator
