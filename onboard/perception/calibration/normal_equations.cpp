// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/normal_equations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace cairn::calibration {
namespace {

constexpr double kFree = 1e-12;  // share of the largest eigenvalue below which a direction is free

}  // namespace

NormalEquations::NormalEquations(Eigen::Index shared, std::size_t views)
    : shared_(Eigen::MatrixXd::Zero(shared, shared)),
      gradient_(Eigen::VectorXd::Zero(shared)),
      views_(views, View{.cross = Eigen::Matrix<double, Eigen::Dynamic, 6>::Zero(shared, 6)}) {}

void NormalEquations::add(std::size_t view, const Eigen::RowVectorXd& shared, const Eigen::Matrix<double, 1, 6>& pose,
                          double residual, double weight) {
  View& v = views_[view];
  shared_.noalias() += weight * shared.transpose() * shared;
  gradient_.noalias() += weight * residual * shared.transpose();
  v.cross.noalias() += weight * shared.transpose() * pose;
  v.pose.noalias() += weight * pose.transpose() * pose;
  v.gradient.noalias() += weight * residual * pose.transpose();
}

std::optional<Step> NormalEquations::solve(double damping) const {
  Eigen::MatrixXd reduced = shared_;
  reduced.diagonal() *= 1 + damping;
  Eigen::VectorXd right = -gradient_;
  std::vector<Eigen::LLT<Matrix6>> factors;
  factors.reserve(views_.size());
  for (const View& v : views_) {
    Matrix6 pose = v.pose;
    pose.diagonal() *= 1 + damping;
    factors.emplace_back(pose);
    if (factors.back().info() != Eigen::Success) return {};
    reduced.noalias() -= v.cross * factors.back().solve(v.cross.transpose());
    right.noalias() += v.cross * factors.back().solve(v.gradient);
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(reduced);
  if (factor.info() != Eigen::Success) return {};
  Step step{.shared = factor.solve(right), .poses = {}};
  for (std::size_t i = 0; i < views_.size(); ++i)
    step.poses.emplace_back(-factors[i].solve(views_[i].gradient + views_[i].cross.transpose() * step.shared));
  return step;
}

Eigen::MatrixXd NormalEquations::information() const {
  Eigen::MatrixXd reduced = shared_;
  for (const View& v : views_) {
    const Eigen::LDLT<Matrix6> factor(v.pose);
    reduced.noalias() -= v.cross * factor.solve(v.cross.transpose());
  }
  return 0.5 * (reduced + reduced.transpose());
}

Eigen::MatrixXd covariance(const Eigen::MatrixXd& information, double variance) {
  const Eigen::Index n = information.rows();
  Eigen::VectorXd scale = information.diagonal().cwiseMax(0).cwiseSqrt();
  for (Eigen::Index i = 0; i < n; ++i)
    if (!(scale[i] > 0)) scale[i] = 1;
  const Eigen::VectorXd unscale = scale.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unscale.asDiagonal() * information * unscale.asDiagonal());
  const double least = kFree * std::max(eigen.eigenvalues().maxCoeff(), 0.0);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd direction = unscale.asDiagonal() * eigen.eigenvectors().col(i);
    if (eigen.eigenvalues()[i] > least) {
      result += variance / eigen.eigenvalues()[i] * direction * direction.transpose();
      continue;
    }
    for (Eigen::Index k = 0; k < n; ++k)
      if (std::abs(eigen.eigenvectors()(k, i)) > 1e-3) result(k, k) = std::numeric_limits<double>::infinity();
  }
  return result;
}

}  // namespace cairn::calibration
