// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/stand_up.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace cairn::matching {
namespace {

// Of the histogram of heights; 1.5 voxels of 0.1 m. By hand, not tuned.
constexpr float kBin_m = 0.15F;
// Of a level surfel's vote: walls say little about height. By hand, not tuned.
constexpr float kUprightVote = 0.25F;
// For each placement: from a prototype, which voted for two as well.
constexpr int kHeights = 2;
// On either side of the highest bin, over which the height is the mean.
constexpr int kMean_bins = 1;
// On either side of the highest bin, before the next height is looked for.
constexpr int kCleared_bins = 2;

/// Votes for b's height in a, from −range_m to range_m.
std::vector<float> votes(const Placement& p, const PlanView& a, const PlanView& b, std::span<const Surfel> sample,
                         float range_m) {
  const int bins = 2 * static_cast<int>(range_m / kBin_m) + 1;
  std::vector<float> all(static_cast<std::size_t>(bins), 0.0F);
  const Eigen::Rotation2Df turn(static_cast<float>(p.yaw_rad));
  const Eigen::Vector2f at(static_cast<float>(p.x_m), static_cast<float>(p.y_m));
  for (const Surfel& s : sample) {
    const bool level = s.level();
    for (const PlanView::Height& h : a.heights(turn * (s.point.head<2>() - b.middle()) + at)) {
      if (h.level != level) continue;
      const float bin = (h.z - s.point.z() + range_m) / kBin_m;
      if (!(bin >= 0 && bin < static_cast<float>(bins - 1))) continue;
      const auto i = static_cast<std::size_t>(bin);
      const float part = bin - static_cast<float>(i), weight = level ? 1 : kUprightVote;
      all[i] += weight * (1 - part);
      all[i + 1] += weight * part;
    }
  }
  return all;
}

/// The heights of b in a with the most votes, m.
std::vector<double> heights_of(std::vector<float> all, float range_m) {
  const int last = static_cast<int>(all.size()) - 1;
  std::vector<double> best;
  for (int k = 0; k < kHeights; ++k) {
    const auto top = std::max_element(all.begin(), all.end());
    if (*top <= 0) break;
    const auto i = static_cast<int>(top - all.begin());
    float sum = 0, moment = 0;
    for (int j = std::max(0, i - kMean_bins); j <= std::min(last, i + kMean_bins); ++j) {
      sum += all[static_cast<std::size_t>(j)];
      moment += all[static_cast<std::size_t>(j)] * static_cast<float>(j);
    }
    best.push_back(static_cast<double>(moment / sum * kBin_m - range_m));
    for (int j = std::max(0, i - kCleared_bins); j <= std::min(last, i + kCleared_bins); ++j)
      all[static_cast<std::size_t>(j)] = 0;
  }
  return best;
}

}  // namespace

std::vector<SE3> stand_up(std::span<const Placement> placements, const PlanView& a, const PlanView& b,
                          std::span<const Surfel> sample, float height_range_m) {
  std::vector<SE3> poses;
  for (const Placement& p : placements) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(p.yaw_rad, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d middle(static_cast<double>(b.middle().x()), static_cast<double>(b.middle().y()), 0);
    for (const double z : heights_of(votes(p, a, b, sample, height_range_m), height_range_m))
      poses.emplace_back(turn, Eigen::Vector3d(p.x_m, p.y_m, z) - turn * middle);
  }
  return poses;
}

}  // namespace cairn::matching
