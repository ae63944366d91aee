// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/em.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace cairn::matching {
namespace {

// Of kIterations, with σ of one voxel. Chosen by hand, not tuned.
constexpr int kLastIterations = 5;
// Iterations from each mode. Chosen by hand, not tuned.
constexpr int kGlances = 4;
// About so many in a glance. Chosen by hand, not tuned.
constexpr std::size_t kGlanceVoxels = 1000;
// The book leaves σ out. With 1 m the descent slid like ICP.
constexpr double kFirstSigma_m = 0.5;
constexpr double kGate_sigmas = 3;  // of a partner: 99.7 %
// Weight of a partner at 2σ. Chosen by hand, not tuned.
const double kNoPartner = std::exp(-0.5 * 2 * 2);

}  // namespace

Em::Em(const MapFeatures& a, const MapFeatures& b)
    : VoxelMatcher(a, b),
      modes_(a, b),
      points_b_(centres_of(voxels_b()), static_cast<float>(kGridCell_voxels * resolution())),
      sparse_(sparser_of(points_a(), points_b_, resolution())) {
  for (std::size_t i = 0; i < sparse_.voxels.size(); ++i)
    correspondences_.push_back(sparse_.partners(i, sparse_.dense_mean));
}

double Em::mean_correspondences() const {
  const double sum = std::accumulate(correspondences_.begin(), correspondences_.end(), 0.0);
  return correspondences_.empty() ? 0 : sum / static_cast<double>(correspondences_.size());
}

std::optional<SE3> Em::step(const SE3& T, const UncertainPose& prior, double sigma, std::size_t stride) const {
  const SE3 T_dense_sparse = sparse_.is_b ? T : T.inverse();
  const PointGrid& dense = sparse_.is_b ? points_a() : points_b_;
  const double gate = std::min(static_cast<double>(kGate_m), kGate_sigmas * sigma);
  Matrix6 H = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
  int pairs = 0;
  std::vector<PointGrid::Neighbour> near;
  for (std::size_t i = 0; i < sparse_.voxels.size(); i += stride) {
    const Eigen::Vector3d x = sparse_.voxels[i].cast<double>();
    const auto count = static_cast<std::size_t>(correspondences_[i]);
    dense.nearest((T_dense_sparse * x).cast<float>(), static_cast<float>(gate), count, near);
    double total = 0;
    Eigen::Vector3d target = Eigen::Vector3d::Zero();
    for (const auto& n : near) {
      const double w = std::exp(-static_cast<double>(n.squared) / (2 * sigma * sigma));
      target += w * dense.points()[static_cast<std::size_t>(n.index)].cast<double>();
      total += w;
    }
    if (near.empty() || !(total > 0)) continue;
    // In b's frame, so that the parameters are a right perturbation of T whichever map is the
    // sparse one.
    const Eigen::Vector3d in_b = sparse_.is_b ? x : Eigen::Vector3d(target / total);
    const Eigen::Vector3d in_a = sparse_.is_b ? Eigen::Vector3d(target / total) : x;
    const Eigen::Vector3d e = in_b - T.inverse() * in_a;
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(), -hat(in_b);
    const double belief = total / (total + kNoPartner);
    H += belief * J.transpose() * J;
    g += belief * J.transpose() * e;
    ++pairs;
  }
  if (pairs < kMinPairs) return std::nullopt;
  const Vector6 away = (prior.mean.inverse() * T).log();
  const Matrix6 Jr = right_jacobian_inverse(away);
  const Matrix6 P = prior.covariance.ldlt().solve(Matrix6::Identity());
  H = H / (sigma * sigma) + Jr.transpose() * P * Jr;
  g = g / (sigma * sigma) + Jr.transpose() * P * away;
  return SE3::exp(H.ldlt().solve(-g));
}

SE3 Em::climb(SE3 T, const UncertainPose& prior, Budget& budget) const {
  const double shrink = std::pow(resolution() / kFirstSigma_m, 1.0 / (kIterations - kLastIterations));
  double sigma = kFirstSigma_m;
  for (int i = 0; i < kIterations && budget.one_more(); ++i, sigma = std::max(resolution(), sigma * shrink)) {
    const auto s = step(T, prior, sigma, 1);
    if (!s) return T;
    T = T * *s;
    if (sigma <= resolution() && negligible(*s)) break;
  }
  return T;
}

SE3 Em::descend(const UncertainPose& prior, Budget& budget) const {
  const std::size_t stride = std::max<std::size_t>(1, sparse_.voxels.size() / kGlanceVoxels);
  SE3 best = prior.mean;
  double most = score(best);
  for (SE3 T : modes_.near(prior)) {
    if (!budget.one_more()) return best;
    for (int i = 0; i < kGlances; ++i)
      if (const auto s = step(T, prior, kFirstSigma_m, stride)) T = T * *s;
    if (const double s = score(T); s > most) {
      most = s;
      best = T;
    }
  }
  return climb(best, prior, budget);
}

}  // namespace cairn::matching
