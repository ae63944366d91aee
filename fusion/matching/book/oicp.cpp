// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/oicp.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "fusion/matching/book/structural_edges.hpp"

namespace cairn::matching {

Oicp::Oicp(const MapFeatures& a, const MapFeatures& b, const Stages& stages)
    : VoxelMatcher(a, b), stages_(stages), normals_a_(voxel_normals(voxels_a(), EdgeOptions{}.normal_radius_cells)) {}

/// The right perturbation that brings the source's voxels onto the planes of their nearest ones.
std::optional<SE3> Oicp::plane_step(const SE3& T) const {
  Matrix6 H = kDamping * Matrix6::Identity();
  Vector6 g = Vector6::Zero();
  int pairs = 0;
  const Eigen::Matrix3d Rt = T.rotation().transpose();
  for (const Voxel& v : sources_b()) {
    const Eigen::Vector3d x = v.centre.cast<double>(), at = T * x;
    const int i = points_a().nearest(at.cast<float>(), kGate_m);
    if (i == PointGrid::kNone) continue;
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d n = Rt * normals_a_[k].cast<double>();
    Vector6 J;
    J << n, x.cross(n);
    H += J * J.transpose();
    g += J * normals_a_[k].cast<double>().dot(at - voxels_a()[k].centre.cast<double>());
    ++pairs;
  }
  if (pairs < kMinPairs) return std::nullopt;
  return SE3::exp(H.ldlt().solve(-g));
}

SE3 Oicp::descend(const UncertainPose& prior, Budget& budget) const {
  SE3 T = prior.mean;
  for (int i = 0; i < stages_.plane_iterations && budget.one_more(); ++i) {
    const auto step = plane_step(T);
    if (!step) return T;
    T = T * *step;
    if (negligible(*step)) break;
  }
  double weight = std::numeric_limits<double>::infinity(), mean_squared = 0;
  for (int i = 0; i < stages_.closed_iterations && budget.one_more(); ++i) {
    const auto step = closed_form_step(T, kGate_m, i == 0 || !stages_.occupancy ? 0 : weight, false, mean_squared);
    if (!step) return T;
    T = *step * T;
    weight = std::min(weight, mean_squared / entropy_a());
    if (negligible(*step)) break;
  }
  return T;
}

}  // namespace cairn::matching
