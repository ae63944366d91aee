// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/degeneracy.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

// Corners and half-seen surfaces tilt planes by more than the noise alone would.
constexpr double kSpuriousFactor = 4.0;

}  // namespace

Degeneracy find_degeneracy(const NormalEquations& n, double max_std_m, double correlation) {
  Degeneracy out;
  out.length_m = n.weight > 0 ? std::max(std::sqrt(n.squared_range / n.weight), 0.1) : 1.0;
  Vector6 scale = Vector6::Ones();
  scale.tail<3>().setConstant(1.0 / out.length_m);
  const Matrix6 information = scale.asDiagonal() * n.aa * scale.asDiagonal();
  const Matrix6 spurious = scale.asDiagonal() * n.spurious * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(information);
  Vector6 kept;
  for (int k = 0; k < 6; ++k) {
    const Vector6 v = eigen.eigenvectors().col(k);
    const double all = std::max(eigen.eigenvalues()[k], 0.0);
    const double real = std::max(all - kSpuriousFactor * v.dot(spurious * v), 0.0);
    const bool vague = real * max_std_m * max_std_m < correlation;
    kept[k] = all > 0 ? std::sqrt(real / all) : 0.0;
    if (2 * real >= all && !vague) continue;
    kept[k] = 2 * real >= all ? kept[k] : 0.0;
    out.directions[static_cast<std::size_t>(out.count++)] = v;
  }
  out.keep = scale.cwiseInverse().asDiagonal() * eigen.eigenvectors() * kept.asDiagonal() *
             eigen.eigenvectors().transpose() * scale.asDiagonal();
  return out;
}

NormalEquations without_degenerate(const NormalEquations& n, const Degeneracy& d) {
  NormalEquations out = n;
  const Matrix6 P = d.keep;
  out.aa = P * n.aa * P.transpose();
  out.taa = P * n.taa * P.transpose();
  out.ttaa = P * n.ttaa * P.transpose();
  out.ar = P * n.ar;
  out.tar = P * n.tar;
  return out;
}

}  // namespace cairn
