// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/thermal/thermal_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cairn::cli {

std::size_t ThermalMap::Hash::operator()(const Key& key) const {
  // Teschner et al., Optimized Spatial Hashing (2003).
  return static_cast<std::size_t>((key[0] * 73'856'093LL) ^ (key[1] * 19'349'663LL) ^ (key[2] * 83'492'791LL));
}

Result<void> ThermalMap::add(const SE3& T_odom_base, std::span<const ThermalPoint> points) {
  for (const ThermalPoint& p : points) {
    const Eigen::Vector3d point = T_odom_base * p.point_base.cast<double>();
    const Eigen::Vector3d cell = (per_m_ * point).array().floor();
    if (!(cell.cwiseAbs().maxCoeff() < 1e9)) continue;
    Sum& sum = sums_[{static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()),
                      static_cast<std::int32_t>(cell.z())}];
    sum.point += point;
    sum.value += p.value;
    ++sum.points;
  }
  if (sums_.size() <= kMostVoxels) return {};
  return Error{Errc::kLimit, "the cloud has more than 8 million voxels", {}, {}, "choose larger ones with --voxel"};
}

std::vector<ThermalMap::Mean> ThermalMap::means() const {
  std::vector<std::pair<Key, Sum>> sorted(sums_.begin(), sums_.end());
  std::ranges::sort(sorted, {}, &std::pair<Key, Sum>::first);
  std::vector<Mean> means;
  means.reserve(sorted.size());
  for (const auto& [key, sum] : sorted)
    means.push_back({.point = (sum.point / sum.points).cast<float>(),
                     .value = static_cast<float>(sum.value / sum.points),
                     .points = static_cast<float>(sum.points)});
  return means;
}

}  // namespace cairn::cli
