// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/refine.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

namespace cairn::matching {
namespace {

// 1 less the variance along a normal over that across it, as in generalised ICP (Segal et al., RSS
// 2009: 0.001).
constexpr float kThin = 0.999F;
// Weight of a pair without a plane, which errs by three times as much. Chosen by hand, not tuned.
constexpr float kClutterWeight = 0.1F;
// On the diagonal of H: keeps a direction that no pair holds invertible.
constexpr double kDamping = 1e-6;

using Matrix36f = Eigen::Matrix<float, 3, 6>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

Eigen::Matrix3f skew(const Eigen::Vector3f& v) {
  Eigen::Matrix3f m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// In the source's frame; without a normal (zero) a surfel is as uncertain across as along.
Eigen::Matrix3f information(const Eigen::Vector3f& n_target, const Eigen::Vector3f& n_source) {
  const Eigen::Matrix3f sum = 2 * Eigen::Matrix3f::Identity() - kThin * n_target * n_target.transpose() -
                              kThin * n_source * n_source.transpose();
  return sum.inverse();
}

/// A height alone; along it as if both normals were upright.
Eigen::Matrix3f information_of_height(const Eigen::Vector3f& up) {
  return 0.5F * Eigen::Matrix3f::Identity() + (0.5F / (1 - kThin) - 0.5F) * up * up.transpose();
}

/// Geman–McClure's weight of a pair by its distance along the normals.
float credit(float cost, float robust_m) {
  const float distance = cost * 2 * (1 - kThin) / (robust_m * robust_m);
  return 1 / ((1 + distance) * (1 + distance));
}

/// How much a surfel's place counts. What stereo saw once is often behind the surface.
float surety(const Surfel& s) { return std::min(1.0F, s.evidence / Surfel::kSeenEvidence); }

}  // namespace

bool level(const Surfel& target, const Surfel& source) { return target.level() && source.level(); }

float weight(const Surfel& target, const Surfel& source) {
  const auto height_variance = [](const Surfel& s) { return 1 - kThin * s.normal.z() * s.normal.z(); };
  if (level(target, source)) return 2 * (1 - kThin) / (height_variance(target) + height_variance(source));
  return target.flat() && source.flat() ? 1 : kClutterWeight;
}

NormalEquations plane_to_plane(std::span<const Surfel> target, const NearestGrid& nearest,
                               std::span<const Surfel> source, const SE3& T, float gate_m, float robust_m) {
  NormalEquations sum;
  const Eigen::Matrix3f R = T.rotation().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  for (const Surfel& s : source) {
    const Eigen::Vector3f q = R * s.point + t;
    const int i = nearest.nearest(q, gate_m);
    if (i == NearestGrid::kNone) continue;
    const Surfel& r = target[static_cast<std::size_t>(i)];
    const Eigen::Vector3f n = R.transpose() * r.normal;
    const float cosine = n.dot(s.normal);
    const Eigen::Vector3f e = R.transpose() * (q - r.point) - off_the_face(r, s, cosine) * n;
    // The two faces of a trunk or a thin wall, seen by one robot each, are not one place.
    if (r.oriented && s.oriented && cosine < 0) continue;
    Eigen::Matrix3f W = level(r, s) ? information_of_height(R.row(2).transpose()) : information(n, s.normal);
    W *= weight(r, s) * surety(r) * surety(s);
    if (robust_m > 0) W *= credit(e.dot(W * e), robust_m);
    Matrix36f J;
    J << Eigen::Matrix3f::Identity(), -skew(s.point);
    const Matrix36f WJ = W * J;
    sum.H += Matrix6f(J.transpose() * WJ).cast<double>();
    sum.g += Eigen::Matrix<float, 6, 1>(WJ.transpose() * e).cast<double>();
    sum.cost += static_cast<double>(e.dot(W * e));
    ++sum.pairs;
  }
  return sum;
}

Refinement refine(std::span<const Surfel> target, const NearestGrid& nearest, std::span<const Surfel> source,
                  const SE3& initial, const RefineOptions& options, Budget& budget) {
  Refinement out{.T_target_source = initial};
  float gate = options.gate_m;
  while (out.iterations < options.max_iterations && budget.one_more()) {
    const NormalEquations sum = plane_to_plane(target, nearest, source, out.T_target_source, gate, options.robust_m);
    ++out.iterations;
    out.pairs = sum.pairs;
    if (sum.pairs < options.min_pairs) break;
    const Vector6 step = (sum.H + kDamping * Matrix6::Identity()).ldlt().solve(-sum.g);
    if (!step.allFinite()) break;
    out.T_target_source = out.T_target_source * SE3::exp(step);
    const bool shrunk = gate <= options.last_gate_m;
    gate = std::max(options.last_gate_m, gate * options.gate_decay);
    if (shrunk && step.head<3>().norm() < options.stop_m && step.tail<3>().norm() < options.stop_rad) break;
  }
  return out;
}

}  // namespace cairn::matching
