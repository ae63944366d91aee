// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/match_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cairn::matching {
namespace {

constexpr double kShared = 9;          // surfels of a plane that share voxels
constexpr double kNormalNoise = 0.1;   // standard deviation of the normal of a flat surfel [rad]; others' is larger
constexpr double kBent = 0.3;          // squared error of a normal, for each unit of variation
constexpr double kMinResidual = 0.02;  // of a cell: no grid is believed to be finer
constexpr double kLevelBias = 0.2;     // of a cell: how far off a floor is that lies along both grids
constexpr float kStretchM = 4, kOffsetM = 0.6F, kNormalSteps = 4, kLevel = 0.85F;
constexpr double kRidge = 1e-9;  // keeps M invertible

/// Which stretch of which surface a surfel of the target belongs to: those of one share their error.
using Stretch = std::array<int, 7>;

struct Agreeing {
  Stretch stretch;
  Vector6 J;
  double residual;
};

/// The normal with a sign that all surfels of a stretch have in common.
Eigen::Vector3f signed_normal(const Surfel& s) {
  return s.normal.dot(Eigen::Vector3f(0.37F, 0.19F, 0.91F)) < 0 ? -s.normal : s.normal;
}

Stretch stretch_of(const Surfel& s) {
  const Eigen::Vector3f n = signed_normal(s);
  const Eigen::Vector3i facing = (kNormalSteps * n).array().round().cast<int>();
  const Eigen::Vector3i block = (s.point / kStretchM).array().floor().cast<int>();
  return {facing.x(), facing.y(), facing.z(), static_cast<int>(std::floor(n.dot(s.point) / kOffsetM)),
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

  /// A normal that errs by σ fakes an information of σ² along the surface, which is taken off again: what is left of
  /// many walls in one direction says nothing about that direction. A round thing's normal errs by as much as it bends.
  void add(const Eigen::Vector3d& x, const Eigen::Vector3d& normal, double variation) {
    const double noise = kNormalNoise * kNormalNoise + kBent * variation;
    const auto A = lever(x);
    H += A * ((1 + noise) * normal * normal.transpose() - noise * Eigen::Matrix3d::Identity()) * A.transpose();
    reach += x.squaredNorm();
    ++count;
  }

  /// H without its negative eigenvalues, with radians scaled to metres by the surfels' distance.
  [[nodiscard]] Matrix6 positive() const {
    const double metres = std::sqrt(std::max(1.0, reach / std::max(1, count)));
    Vector6 scale = Vector6::Ones();
    scale.tail<3>().setConstant(1 / metres);
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scale.asDiagonal() * H * scale.asDiagonal());
    const Matrix6 V = solver.eigenvectors();
    const Matrix6 clipped = V * solver.eigenvalues().cwiseMax(0).asDiagonal() * V.transpose();
    return scale.cwiseInverse().asDiagonal() * clipped * scale.cwiseInverse().asDiagonal();
  }
};

/// Sums over one stretch.
struct Sum {
  Vector6 J = Vector6::Zero();
  double residual = 0, squares = 0;
  int count = 0;
};

std::vector<Sum> by_stretch(std::vector<Agreeing>& all) {
  std::stable_sort(all.begin(), all.end(), [](const Agreeing& x, const Agreeing& y) { return x.stretch < y.stretch; });
  std::vector<Sum> sums;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i == 0 || all[i].stretch != all[i - 1].stretch) sums.emplace_back();
    Sum& s = sums.back();
    s.J += all[i].J;
    s.residual += all[i].residual;
    s.squares += all[i].residual * all[i].residual;
    ++s.count;
  }
  return sums;
}

/// M, the covariance of Σ J r, of surfaces of one kind.
Matrix6 gradient_covariance(std::vector<Agreeing>& all, double least_variance) {
  Matrix6 single = Matrix6::Zero(), common = Matrix6::Zero();
  double between = 0, within = 0;
  int freedoms = 0;
  for (const Agreeing& p : all) single += p.J * p.J.transpose();
  for (const Sum& s : by_stretch(all)) {
    common += s.J * s.J.transpose();
    between += s.residual * s.residual / s.count;  // by size: a lone surfel is no stretch
    within += s.squares - s.residual * s.residual / s.count;
    freedoms += s.count - 1;
  }
  const double of_single = std::max(least_variance, within / std::max(1, freedoms));
  const double of_common = std::max(least_variance, between / std::max<double>(1, static_cast<double>(all.size())));
  return kShared * of_single * single + of_common * common;
}

/// What of M is due to floors lying along both grids, all off by one part of a cell.
Matrix6 level_bias(const std::vector<Agreeing>& level, double bias_m) {
  Vector6 J = Vector6::Zero();
  for (const Agreeing& p : level) J += p.J;
  return bias_m * bias_m * J * J.transpose();
}

}  // namespace

Matrix6 covariance(const Party& target, const NearestGrid& nearest, const Party& source, const SE3& T,
                   const Matrix6& prior_covariance) {
  const Eigen::Matrix3f R = T.rotation().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  const auto cell = static_cast<float>(std::max(target.cell_m, source.cell_m));
  Normals sum;
  std::vector<Agreeing> level, other;
  for (const Surfel& s : source.sample) {
    const Eigen::Vector3f q = R * s.point + t;
    const int i = nearest.nearest(q, cell);
    if (i == NearestGrid::kNone) continue;
    const Surfel& r = target.surfels[static_cast<std::size_t>(i)];
    if (!same_side(r, s, R * s.normal) || one_face(r, s)) continue;
    const Eigen::Vector3f normal = signed_normal(r);
    const Eigen::Vector3d x = s.point.cast<double>(), n = (R.transpose() * normal).cast<double>();
    sum.add(x, n, static_cast<double>(std::max(r.variation, s.variation)));
    (std::abs(normal.z()) > kLevel ? level : other)
        .push_back({stretch_of(r), lever(x) * n, static_cast<double>(normal.dot(q - r.point))});
  }
  const double least = kMinResidual * static_cast<double>(cell), bias = kLevelBias * static_cast<double>(cell);
  const Matrix6 H = sum.positive();
  const Matrix6 M = gradient_covariance(level, least * least) + gradient_covariance(other, least * least) +
                    level_bias(level, bias) + kRidge * (1 + sum.count) * Matrix6::Identity();
  const Matrix6 information = H * M.ldlt().solve(H) + prior_covariance.ldlt().solve(Matrix6::Identity());
  const Matrix6 inverse = information.ldlt().solve(Matrix6::Identity());
  return 0.5 * (inverse + inverse.transpose());
}

}  // namespace cairn::matching
