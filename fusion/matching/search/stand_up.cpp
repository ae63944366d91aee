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

// A bound on time and memory: 1 200 m.
constexpr int kMost_bins = 8000;

/// A histogram of heights of b in a, from `low_m` on: all at which the two maps can meet.
struct Histogram {
  Histogram(const PlanView& a, std::span<const Surfel> sample) {
    float bottom = 0, top = 0;
    if (!sample.empty()) bottom = top = sample.front().point.z();
    for (const Surfel& s : sample) {
      bottom = std::min(bottom, s.point.z());
      top = std::max(top, s.point.z());
    }
    const float span_m = a.top() - a.bottom() + top - bottom;
    const int bins = static_cast<int>(std::min(static_cast<float>(kMost_bins), span_m / kBin_m + 2));
    low_m = 0.5F * (a.bottom() + a.top() - bottom - top) - 0.5F * kBin_m * static_cast<float>(bins - 1);
    votes.resize(static_cast<std::size_t>(bins));
  }

  float low_m;
  std::vector<float> votes;
};

void vote(const Placement& p, const PlanView& a, const PlanView& b, std::span<const Surfel> sample, Histogram& all) {
  std::fill(all.votes.begin(), all.votes.end(), 0.0F);
  const Eigen::Rotation2Df turn(static_cast<float>(p.yaw_rad));
  const Eigen::Vector2f at(static_cast<float>(p.x_m), static_cast<float>(p.y_m));
  const auto last = static_cast<float>(all.votes.size() - 1);
  for (const Surfel& s : sample) {
    const bool level = s.level();
    for (const PlanView::Height& h : a.heights(turn * (s.point.head<2>() - b.middle()) + at)) {
      if (h.level != level) continue;
      const float bin = (h.z - s.point.z() - all.low_m) / kBin_m;
      if (!(bin >= 0 && bin < last)) continue;
      const auto i = static_cast<std::size_t>(bin);
      const float part = bin - static_cast<float>(i), weight = level ? 1 : kUprightVote;
      all.votes[i] += weight * (1 - part);
      all.votes[i + 1] += weight * part;
    }
  }
}

/// The heights of b in a with the most votes, m. Takes the votes out.
std::vector<double> heights_of(Histogram& all) {
  const int last = static_cast<int>(all.votes.size()) - 1;
  std::vector<double> best;
  for (int k = 0; k < kHeights; ++k) {
    const auto top = std::max_element(all.votes.begin(), all.votes.end());
    if (*top <= 0) break;
    const auto i = static_cast<int>(top - all.votes.begin());
    float sum = 0, moment = 0;
    for (int j = std::max(0, i - kMean_bins); j <= std::min(last, i + kMean_bins); ++j) {
      sum += all.votes[static_cast<std::size_t>(j)];
      moment += all.votes[static_cast<std::size_t>(j)] * static_cast<float>(j);
    }
    best.push_back(static_cast<double>(moment / sum * kBin_m + all.low_m));
    for (int j = std::max(0, i - kCleared_bins); j <= std::min(last, i + kCleared_bins); ++j)
      all.votes[static_cast<std::size_t>(j)] = 0;
  }
  return best;
}

}  // namespace

std::vector<SE3> stand_up(std::span<const Placement> placements, const PlanView& a, const PlanView& b,
                          std::span<const Surfel> sample) {
  std::vector<SE3> poses;
  Histogram all(a, sample);
  for (const Placement& p : placements) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(p.yaw_rad, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d middle(static_cast<double>(b.middle().x()), static_cast<double>(b.middle().y()), 0);
    vote(p, a, b, sample, all);
    for (const double z : heights_of(all)) poses.emplace_back(turn, Eigen::Vector3d(p.x_m, p.y_m, z) - turn * middle);
  }
  return poses;
}

}  // namespace cairn::matching
