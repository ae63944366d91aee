// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/path.hpp"

#include <algorithm>

namespace cairn::cli {

Result<Path> Path::read(const std::filesystem::path& file) {
  auto poses = recording::read_tum(file);
  if (!poses) return cairn::at(file.string(), poses.error());
  if (poses->empty()) return Error{Errc::kMalformed, "there is no pose", file.string(), {}, {}};
  return Path(*std::move(poses));
}

SE3 Path::at(Time t) const {
  const auto after = std::ranges::lower_bound(poses_, t, {}, &recording::StampedPose::stamp);
  if (after == poses_.begin()) return poses_.front().pose;
  if (after == poses_.end()) return poses_.back().pose;
  const auto& before = *(after - 1);
  const double share = to_seconds(t - before.stamp) / to_seconds(after->stamp - before.stamp);
  return before.pose * SE3::exp(share * (before.pose.inverse() * after->pose).log());
}

bool Path::has_pose_near(Time t, Duration apart) const {
  const auto after = std::ranges::lower_bound(poses_, t - apart, {}, &recording::StampedPose::stamp);
  return after != poses_.end() && after->stamp <= t + apart;
}

Path Path::moved(const SE3& T_to_from) const {
  Path path = *this;
  for (recording::StampedPose& pose : path.poses_) pose.pose = T_to_from * pose.pose;
  return path;
}

}  // namespace cairn::cli
