// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/em_book.hpp"

#include <cmath>

#include "fusion/matching/book/alignment.hpp"

namespace cairn::matching {

EmBook::EmBook(const MapFeatures& a, const MapFeatures& b)
    : VoxelMatcher(a, b),
      points_b_(centres_of(voxels_b()), static_cast<float>(kGridCell_voxels * resolution())),
      sparse_(sparser_of(points_a(), points_b_, resolution())) {}

std::optional<SE3> EmBook::step(const SE3& T, std::vector<int>& densities) const {
  const SE3 T_dense_sparse = sparse_.is_b ? T : T.inverse();
  const PointGrid& dense = sparse_.is_b ? points_a() : points_b_;
  const auto radius = SparseMap::kRadius_voxels * static_cast<float>(resolution());
  Alignment pairs;
  std::vector<PointGrid::Neighbour> near;
  for (std::size_t i = 0; i < sparse_.voxels.size(); ++i) {
    const Eigen::Vector3d at = T_dense_sparse * sparse_.voxels[i].cast<double>();
    const int nearest = dense.nearest(at.cast<float>(), kGate_m);
    if (nearest == PointGrid::kNone) continue;
    int& density = densities[static_cast<std::size_t>(nearest)];
    if (density < 0) density = dense.count(dense.points()[static_cast<std::size_t>(nearest)], radius);
    dense.nearest(at.cast<float>(), kGate_m, static_cast<std::size_t>(sparse_.partners(i, density)), near);
    for (const auto& n : near) {
      const Eigen::Vector3d partner = dense.points()[static_cast<std::size_t>(n.index)].cast<double>();
      pairs.add(at, partner, std::exp(-static_cast<double>(n.squared)));
    }
  }
  if (pairs.pairs() < kMinPairs) return std::nullopt;
  const SE3 moved = pairs.solve();  // of the sparse map in the dense one's frame
  return sparse_.is_b ? moved : T * moved.inverse() * T.inverse();
}

SE3 EmBook::descend(const UncertainPose& prior, Budget& budget) const {
  SE3 T = prior.mean;
  std::vector<int> densities((sparse_.is_b ? points_a() : points_b_).points().size(), -1);
  for (int i = 0; i < kIterations && budget.one_more(); ++i) {
    const auto moved = step(T, densities);
    if (!moved) return T;
    T = *moved * T;
    if (negligible(*moved)) break;
  }
  return T;
}

}  // namespace cairn::matching
