// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/voxel_densities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "fusion/matching/book/voxel_matcher.hpp"
#include "fusion/matching/features/sample.hpp"

namespace cairn::matching {
namespace {

struct Sampled {
  std::vector<Eigen::Vector3f> voxels;
  std::vector<int> densities;

  Sampled(const PointGrid& grid, double resolution)
      : voxels(sample(std::span<const Eigen::Vector3f>(grid.points()), VoxelMatcher::kMostSources)) {
    const float radius = SparseMap::kRadius_voxels * static_cast<float>(resolution);
    densities.reserve(voxels.size());
    for (const Eigen::Vector3f& v : voxels) densities.push_back(grid.count(v, radius));
  }
  [[nodiscard]] double mean() const {
    return densities.empty()
               ? 0
               : std::accumulate(densities.begin(), densities.end(), 0.0) / static_cast<double>(densities.size());
  }
};

}  // namespace

int SparseMap::partners(std::size_t i, double dense) const {
  if (alike) return 1;
  return std::clamp(static_cast<int>(std::lround(dense / std::max(1, densities[i]))), 1, kMostPartners);
}

SparseMap sparser_of(const PointGrid& a, const PointGrid& b, double resolution) {
  Sampled of_a(a, resolution), of_b(b, resolution);
  const double mean_a = of_a.mean(), mean_b = of_b.mean();
  SparseMap sparse;
  sparse.is_b = mean_b <= mean_a;
  Sampled& chosen = sparse.is_b ? of_b : of_a;
  sparse.voxels = std::move(chosen.voxels);
  sparse.densities = std::move(chosen.densities);
  sparse.dense_mean = std::max(mean_a, mean_b);
  sparse.alike = std::lround(sparse.dense_mean / std::max(1.0, std::min(mean_a, mean_b))) <= 1;
  return sparse;
}

}  // namespace cairn::matching
