// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/pmm.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace cairn::matching {
namespace {

// Of the first level: the book needs about 15 (section 4.6.2).
constexpr int kEdgeIterations = 15;
constexpr int kVoxelIterations = 15;        // of the second level: both make the protocol's 30
constexpr int kEdgeIterationsAlone = 30;    // the protocol's (section 4.6.3)
constexpr float kVoxelGate_m = 0.5F;        // of the second level. The book leaves it out
constexpr double kEdgeGridCell_voxels = 5;  // edge of a cell of PointGrid. For time only

}  // namespace

Pmm::Pmm(const MapFeatures& a, const MapFeatures& b, bool probabilistic)
    : VoxelMatcher(a, b),
      probabilistic_(probabilistic),
      edges_a_(structural_edges(voxels_a(), a.resolution())),
      edges_b_(structural_edges(voxels_b(), b.resolution())),
      edge_points_a_(centres_of(edges_a_.voxels), static_cast<float>(kEdgeGridCell_voxels * resolution())) {}

std::optional<SE3> Pmm::edge_step(const SE3& T, const Weights& weights, double& mean_squared) const {
  Matrix6 H = kDamping * Matrix6::Identity();
  Vector6 g = Vector6::Zero();
  double squares = 0;
  int pairs = 0;
  const Eigen::Matrix3d R = T.rotation();
  const Eigen::Matrix3f Rf = R.cast<float>();
  const auto w_o = static_cast<float>(weights.occupancy), w_t = static_cast<float>(weights.direction);
  for (std::size_t s = 0; s < edges_b_.voxels.size(); ++s) {
    const Voxel& v = edges_b_.voxels[s];
    const Eigen::Vector3d x = v.centre.cast<double>(), at = T * x;
    const Eigen::Vector3f direction = Rf * edges_b_.directions[s];
    const int i = edge_points_a_.nearest(at.cast<float>(), kGate_m, [&](int k, float squared) {
      const auto r = static_cast<std::size_t>(k);
      const float p = edges_a_.voxels[r].occupancy - v.occupancy;
      // |τ_r ∓ τ_s|² = 2 − 2|τ_r·τ_s|.
      const float along = std::abs(edges_a_.directions[r].dot(direction));
      return squared + w_o * p * p + w_t * (2 - 2 * std::min(along, 1.0F));
    });
    if (i == PointGrid::kNone) continue;
    const auto r = static_cast<std::size_t>(i);
    const Eigen::Vector3d e = at - edges_a_.voxels[r].centre.cast<double>();
    Eigen::Matrix3d W = Eigen::Matrix3d::Identity();
    if (probabilistic_) {
      const Eigen::Matrix3f sum = edges_a_.covariances[r] + Rf * edges_b_.covariances[s] * Rf.transpose();
      W = sum.cast<double>().inverse();
    }
    Eigen::Matrix<double, 3, 6> J;
    J << R, -R * hat(x);
    H += J.transpose() * W * J;
    g += J.transpose() * W * e;
    squares += e.squaredNorm();
    ++pairs;
  }
  mean_squared = pairs > 0 ? squares / pairs : 0;
  if (pairs < kMinPairs) return std::nullopt;
  return SE3::exp(H.ldlt().solve(-g));
}

SE3 Pmm::match_edges(SE3 T, int iterations, Budget& budget) const {
  const double entropy = std::max(kLeastEntropy_bits, book_map_entropy(edges_a_.voxels));
  const double quality = 0.5 * (edges_a_.quality + edges_b_.quality);
  double least = std::numeric_limits<double>::infinity(), mean_squared = 0;
  for (int i = 0; i < iterations && budget.one_more(); ++i) {
    const Weights weights = i == 0 || !probabilistic_ ? Weights{} : Weights{least / entropy, least * quality};
    const auto step = edge_step(T, weights, mean_squared);
    if (!step) return T;
    T = T * *step;
    least = std::min(least, mean_squared);
    if (negligible(*step)) break;
  }
  return T;
}

SE3 Pmm::descend(const UncertainPose& prior, Budget& budget) const {
  SE3 T = match_edges(prior.mean, kEdgeIterations, budget);
  double mean_squared = 0, weight = 0;
  for (int i = 0; i < kVoxelIterations && budget.one_more(); ++i) {
    const auto step = closed_form_step(T, kVoxelGate_m, weight, true, mean_squared);
    if (!step) return T;
    T = *step * T;
    weight = i == 0 ? mean_squared / entropy_a() : std::min(weight, mean_squared / entropy_a());
    if (negligible(*step)) break;
  }
  return T;
}

SE3 PmmLevel1::descend(const UncertainPose& prior, Budget& budget) const {
  return match_edges(prior.mean, kEdgeIterationsAlone, budget);
}

}  // namespace cairn::matching
