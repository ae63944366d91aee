// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/degeneracy.hpp"

#include <algorithm>
#include <cmath>

#include "hal/symmetric_eigen.hpp"

namespace cairn::odometry {
namespace {

// sin² of 5.7°. The normals of patches are noisy by max_tilt_rad = 1.7° and by curved surfaces;
// test NoisyNormalsOfThousandsOfPointsDoNotHideIt has 2.9°.
constexpr float kSquaredSineOfNoise = 0.01F;
// m. Below it a lever arm has no meaning: all points would lie in the sensor.
constexpr double kShortestLever_m = 0.1;

/// Stops counting at `enough`: well determined directions are recognised after a few rows.
bool enough_facing(std::span<const ResidualRow> rows, const Vector6& direction, double enough) {
  const Eigen::Vector3f shift = direction.head<3>().cast<float>(), turn = direction.tail<3>().cast<float>();
  double facing = 0;
  for (const ResidualRow& row : rows) {
    if (row.robust == 0) continue;
    const Eigen::Vector3f motion = shift + turn.cross(row.point);
    const float along_normal = row.normal.dot(motion), squared = motion.squaredNorm();
    if (along_normal * along_normal < kSquaredSineOfNoise * squared) continue;
    facing += row.robust * along_normal * along_normal / squared;
    if (facing >= enough) return true;
  }
  return false;
}

}  // namespace

Degeneracy find_degeneracy(const NormalEquations& n, std::span<const ResidualRow> rows, double min_facing_points) {
  Degeneracy out;
  out.length_m = n.weight > 0 ? std::max(std::sqrt(n.squared_range / n.weight), kShortestLever_m) : 1.0;
  Vector6 scale = Vector6::Ones();
  scale.tail<3>().setConstant(1.0 / out.length_m);
  const Matrix6 information = scale.asDiagonal() * n.aa * scale.asDiagonal();
  const Matrix6 V = symmetric_eigen(information).vectors;
  Vector6 lost = Vector6::Zero();
  for (int k = 0; k < 6; ++k) {
    if (enough_facing(rows, scale.asDiagonal() * V.col(k), min_facing_points)) continue;
    lost[k] = 1.0;
    out.directions[static_cast<std::size_t>(out.count++)] = V.col(k);
  }
  if (out.count == 0) return out;
  const Matrix6 lose = V * lost.asDiagonal() * V.transpose();
  out.undetermined = scale.asDiagonal() * lose * scale.cwiseInverse().asDiagonal();
  out.keep = Matrix6::Identity() - out.undetermined.transpose();
  return out;
}

NormalEquations without_degenerate(const NormalEquations& n, const Degeneracy& d) {
  if (d.count == 0) return n;
  NormalEquations out = n;
  const Matrix6& P = d.keep;
  out.aa = P * n.aa * P.transpose();
  out.taa = P * n.taa * P.transpose();
  out.ttaa = P * n.ttaa * P.transpose();
  out.ar = P * n.ar;
  out.tar = P * n.tar;
  return out;
}

}  // namespace cairn::odometry
