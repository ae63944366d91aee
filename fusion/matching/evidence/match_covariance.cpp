// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/match_covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fusion/matching/search/refine.hpp"
#include "hal/symmetric_eigen.hpp"

namespace cairn::matching {
namespace {

// The noise model. Its values were chosen on tests/bench/matching_covariance, seeds below 5000, so
// that NEES/6 is near 1 (0.7 to 0.8 in random buildings of seeds from 5000 on). Each by itself is
// by hand.

// Surfels of a plane that share voxels, as the errors show it; by geometry 9.
constexpr double kShared = 4;
// Standard deviation of the normal of a flat surfel; others' is larger.
constexpr double kNormalNoise_rad = 0.1;
constexpr double kBent_rad2 = 0.3;  // squared error of a normal, for each unit of variation
// Standard deviation, at least: no grid is believed to be finer.
constexpr double kMinResidual_cells = 0.02;
constexpr double kLevelBias_cells = 0.2;  // how far off a floor is that lies along both grids
// A stretch of a surface: a cube of this edge, planes this far apart, normals rounded to quarters.
constexpr float kStretch_m = 4, kOffset_m = 0.6F, kNormalSteps = 4;
constexpr double kRidge = 1e-9;  // for each surfel: keeps M invertible

/// The stretch of a surface to which a surfel of the target belongs. Surfels of one stretch share
/// their error. Three numbers are the normal, one the offset, three the cube.
using Stretch = std::array<int, 7>;
constexpr int kSurface = 4;  // the first four tell surfaces apart

struct Agreeing {
  Stretch stretch;
  Vector6 J;
  double residual, weight;
};

/// The normal with a sign that all surfels of a stretch have in common.
Eigen::Vector3f signed_normal(const Surfel& s) {
  const Eigen::Vector3f arbitrary(0.37F, 0.19F, 0.91F);  // perpendicular to no axis of the map
  return s.normal.dot(arbitrary) < 0 ? -s.normal : s.normal;
}

Stretch stretch_of(const Surfel& s) {
  const Eigen::Vector3f n = signed_normal(s);
  const Eigen::Vector3i facing = (kNormalSteps * n).array().round().cast<int>();
  const Eigen::Vector3i block = (s.point / kStretch_m).array().floor().cast<int>();
  return {facing.x(), facing.y(), facing.z(), static_cast<int>(std::floor(n.dot(s.point) / kOffset_m)),
          block.x(),  block.y(),  block.z()};
}

/// J = A n with A = (I, [x]×)ᵀ, in the source's frame.
Eigen::Matrix<double, 6, 3> lever(const Eigen::Vector3d& x) {
  Eigen::Matrix<double, 6, 3> A;
  A << Eigen::Matrix3d::Identity(), hat(x);
  return A;
}

/// Σ J Jᵀ over surfels that agree.
struct Normals {
  Matrix6 H = Matrix6::Zero();
  double reach = 0;  // squared distances from the origin
  int count = 0;

  /// Takes off the information of σ² along the surface that a normal fakes which errs by σ. Many
  /// walls in one direction then say nothing about that direction. The normal of a round thing errs
  /// by as much as it bends.
  void add(const Eigen::Vector3d& x, const Eigen::Vector3d& normal, double variation, double weight) {
    const double noise = kNormalNoise_rad * kNormalNoise_rad + kBent_rad2 * variation;
    const auto A = lever(x);
    H += weight * A * ((1 + noise) * normal * normal.transpose() - noise * Eigen::Matrix3d::Identity()) * A.transpose();
    reach += x.squaredNorm();
    ++count;
  }

  /// H without its negative eigenvalues, with radians scaled to metres by the surfels' distance.
  [[nodiscard]] Matrix6 positive() const {
    const double metres = std::sqrt(std::max(1.0, reach / std::max(1, count)));
    Vector6 scale = Vector6::Ones();
    scale.tail<3>().setConstant(1 / metres);
    const auto [values, V, converged] = symmetric_eigen(scale.asDiagonal() * H * scale.asDiagonal());
    const Matrix6 clipped = V * values.cwiseMax(0).asDiagonal() * V.transpose();
    return scale.cwiseInverse().asDiagonal() * clipped * scale.cwiseInverse().asDiagonal();
  }
};

/// Weighted sums over one stretch.
struct Sum {
  Vector6 J = Vector6::Zero();
  double residual = 0, squares = 0, weight = 0;
  int count = 0;

  /// The weighted square of the residual that all of the stretch have in common.
  [[nodiscard]] double common() const { return residual * residual / weight; }
};

std::vector<Sum> by_stretch(std::vector<Agreeing>& all) {
  std::stable_sort(all.begin(), all.end(), [](const Agreeing& x, const Agreeing& y) { return x.stretch < y.stretch; });
  std::vector<Sum> sums;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == 0 || all[i].stretch != all[i - 1].stretch) sums.emplace_back();
    Sum& s = sums.back();
    const double w = all[i].weight;
    s.J += w * all[i].J;
    s.residual += w * all[i].residual;
    s.squares += w * all[i].residual * all[i].residual;
    s.weight += w;
    ++s.count;
  }
  return sums;
}

/// M, the covariance of Σ w J r, of surfaces of one kind. A weight is the inverse of a variance but
/// for the unit.
Matrix6 gradient_covariance(std::vector<Agreeing>& all, double least_variance) {
  Matrix6 single = Matrix6::Zero(), common = Matrix6::Zero();
  double between = 0, within = 0, weight = 0;
  int freedoms = 0;
  for (const Agreeing& p : all) single += p.weight * p.J * p.J.transpose();
  for (const Sum& s : by_stretch(all)) {
    common += s.J * s.J.transpose();
    between += s.common();  // by size: a lone surfel is no stretch
    within += s.squares - s.common();
    weight += s.weight;
    freedoms += s.count - 1;
  }
  const double of_single = std::max(least_variance, within / std::max(1, freedoms));
  const double of_common = std::max(least_variance, weight > 0 ? between / weight : 0);
  return kShared * of_single * single + of_common * common;
}

/// The part of M that is due to floors along both grids: all of them are off by one part of a cell.
Matrix6 level_bias(const std::vector<Agreeing>& ground, double bias_m) {
  Vector6 J = Vector6::Zero();
  for (const Agreeing& p : ground) J += p.weight * p.J;
  return bias_m * bias_m * J * J.transpose();
}

/// Mean square of the residuals without what is common to all of one floor or ceiling.
double roughness(std::vector<Agreeing>& ground) {
  for (Agreeing& p : ground) std::fill(p.stretch.begin() + kSurface, p.stretch.end(), 0);
  double rough = 0, weight = 0;
  for (const Sum& s : by_stretch(ground)) {
    rough += s.squares - s.common();
    weight += s.weight;
  }
  return weight > 0 ? rough / weight : 0;
}

/// The part of M that is due to sloping ground. Such ground is off by parts of a cell, up to where
/// it reaches the next layer of voxels. The fit takes the part that changes along the ground for a
/// lean of the map. That part is as large as the residuals that are left.
Matrix6 slope_bias(const std::vector<Agreeing>& ground, double variance) {
  Vector6 J = Vector6::Zero(), squares = Vector6::Zero();
  double weight = 0;
  for (const Agreeing& p : ground) {
    J += p.weight * p.J;
    squares += p.weight * p.J.cwiseAbs2();
    weight += p.weight;
  }
  Matrix6 sum = Matrix6::Zero();
  for (const int lean : {3, 4}) {  // of J, how far from the origin a surfel is across
    const double mean = J[lean] / weight, spread = squares[lean] / weight - mean * mean;
    if (!(spread > 0)) continue;
    Vector6 along = Vector6::Zero();
    for (const Agreeing& p : ground) along += p.weight * (p.J[lean] - mean) * p.J;
    sum += variance / spread * along * along.transpose();
  }
  return sum;
}

}  // namespace

Matrix6 covariance(const SurfaceModel& target, const NearestGrid& nearest, const SurfaceModel& source, const SE3& T,
                   const Matrix6& prior_covariance, const EvidenceConfig& config) {
  const Eigen::Matrix3f R = T.rotation().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  const auto cell = static_cast<float>(std::max(target.cell_m, source.cell_m));
  Normals sum;
  std::vector<Agreeing> ground, other;
  for (const Surfel& s : source.sample) {
    const Eigen::Vector3f q = R * s.point + t;
    const int i = nearest.nearest(q, cell);
    if (i == NearestGrid::kNone) continue;
    const Surfel& r = target.surfels[static_cast<std::size_t>(i)];
    if (!same_side(r, s, R * s.normal, config.same_normal)) continue;
    const Eigen::Vector3f normal = signed_normal(r);
    const Eigen::Vector3f e = q - r.point - off_the_face(r, s, r.normal.dot(R * s.normal)) * r.normal;
    const Eigen::Vector3d x = s.point.cast<double>(), n = (R.transpose() * normal).cast<double>();
    const auto w = static_cast<double>(weight(r, s));
    sum.add(x, n, static_cast<double>(std::max(r.variation, s.variation)), w);
    (level(r, s) ? ground : other)
        .push_back(
            {.stretch = stretch_of(r), .J = lever(x) * n, .residual = static_cast<double>(normal.dot(e)), .weight = w});
  }
  const double least = kMinResidual_cells * static_cast<double>(cell),
               bias = kLevelBias_cells * static_cast<double>(cell);
  const Matrix6 H = sum.positive(), of_ground = gradient_covariance(ground, least * least);
  const double rough = roughness(ground);
  const Matrix6 M = of_ground + gradient_covariance(other, least * least) + level_bias(ground, bias) +
                    slope_bias(ground, rough) + kRidge * (1 + sum.count) * Matrix6::Identity();
  const Matrix6 information = H * M.ldlt().solve(H) + prior_covariance.ldlt().solve(Matrix6::Identity());
  const Matrix6 inverse = information.ldlt().solve(Matrix6::Identity());
  return 0.5 * (inverse + inverse.transpose());
}

}  // namespace cairn::matching
