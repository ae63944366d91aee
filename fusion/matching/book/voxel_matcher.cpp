// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/voxel_matcher.hpp"

#include <algorithm>

#include "fusion/matching/book/alignment.hpp"
#include "fusion/matching/features/sample.hpp"

namespace cairn::matching {

std::vector<Eigen::Vector3f> centres_of(const std::vector<Voxel>& voxels) {
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(voxels.size());
  for (const Voxel& v : voxels) centres.push_back(v.centre);
  return centres;
}

bool negligible(const SE3& step) {
  constexpr double kStep_m = 1e-4, kStep_rad = 1e-5;  // chosen by hand, not tuned
  return step.translation().norm() < kStep_m && rotation_angle(step) < kStep_rad;
}

VoxelMatcher::VoxelMatcher(const MapFeatures& a, const MapFeatures& b)
    : judge_(a, b), resolution_(std::max(a.resolution(), b.resolution())), points_a_({}, 0), entropy_a_(0) {
  auto of_a = occupied_voxels(a.map(), kMostVoxels), of_b = occupied_voxels(b.map(), kMostVoxels);
  too_large_ = !of_a || !of_b;
  if (too_large_) return;
  voxels_a_ = *std::move(of_a);
  voxels_b_ = *std::move(of_b);
  sources_b_ = sample(std::span<const Voxel>(voxels_b_), kMostSources);
  points_a_ = PointGrid(centres_of(voxels_a_), static_cast<float>(kGridCell_voxels * resolution_));
  entropy_a_ = std::max(kLeastEntropy_bits, book_map_entropy(voxels_a_));
}

Result<MatchResult> VoxelMatcher::match(const std::optional<UncertainPose>& initial, Budget& budget) const {
  if (auto answer = judge_.without_search(initial)) return *std::move(answer);
  const UncertainPose prior = initial.value_or(anywhere());
  if (too_large_) return refused(prior, "a map holds more voxels than this method takes");
  return judge_.conclude(descend(prior, budget), prior.covariance, 0, budget);
}

int VoxelMatcher::associate(const Eigen::Vector3f& at, float occupancy, float gate_m, double occupancy_weight) const {
  const auto weight = static_cast<float>(occupancy_weight);
  return points_a_.nearest(at, gate_m, [&](int i, float squared) {
    const float d = voxels_a_[static_cast<std::size_t>(i)].occupancy - occupancy;
    return squared + weight * d * d;
  });
}

std::optional<SE3> VoxelMatcher::closed_form_step(const SE3& T, float gate_m, double occupancy_weight, bool weighted,
                                                  double& mean_squared) const {
  Alignment pairs;
  for (const Voxel& v : sources_b_) {
    const Eigen::Vector3d at = T * v.centre.cast<double>();
    const int i = associate(at.cast<float>(), v.occupancy, gate_m, occupancy_weight);
    if (i == PointGrid::kNone) continue;
    const Voxel& r = voxels_a_[static_cast<std::size_t>(i)];
    const double weight =
        weighted ? 1 / (1 / static_cast<double>(r.occupancy) + 1 / static_cast<double>(v.occupancy)) : 1;
    pairs.add(at, r.centre.cast<double>(), weight);
  }
  mean_squared = pairs.mean_squared();
  if (pairs.pairs() < kMinPairs) return std::nullopt;
  return pairs.solve();
}

}  // namespace cairn::matching
