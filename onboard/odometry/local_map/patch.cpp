// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/patch.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// In edges. Along each axis one of the two staggered grids has any point within a quarter edge of
// its block's centre; the other 0.05 are for the noise.
constexpr float kCentral = 0.3F;
// Cosine of 45°: a normal that points along an axis of the grid.
constexpr float kAlongAnAxis = 0.7F;

Eigen::Matrix3f covariance_of(const Moments& m) {
  Eigen::Matrix3f c;
  c << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  return (c - m.sum * m.sum.transpose() / m.count) / (m.count - 1.0F);
}

/// The plane may be no more than the surface that a laser sweeps as it turns. Where ranges scatter
/// (leaves, furniture), the points of one ring lie on it exactly, whatever reflected them. Such a
/// plane would follow the sensor.
bool swept_by_laser(const Patch& patch, const PatchCriteria& criteria, const Viewpoint& from) {
  constexpr float kFacesSideways = 0.7F;  // cosine of 45°: a wall at a grazing angle faces sideways; no laser sweeps it
  const Eigen::Vector3f ray = (from.to_sensor - patch.centroid).normalized();
  const Eigen::Vector3f sideways = from.up.cross(ray);
  constexpr float kTiltSigmas = 2.0F;
  const float least = criteria.min_incidence_rad + kTiltSigmas * std::sqrt(patch.tilt_variance());
  return std::abs(patch.normal.direction.dot(ray)) < least &&
         std::abs(patch.normal.direction.dot(sideways)) < kFacesSideways * sideways.norm();
}

bool fit_plane(const Eigen::Matrix3f& covariance, float edge, const PatchCriteria& criteria, const Viewpoint& from,
               Patch& patch) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen(covariance);
  // Three parameters were fitted; few points look flatter than they are.
  const float across = std::max(eigen.eigenvalues()[0], 0.0F) * (patch.count - 1.0F) / (patch.count - 3.0F);
  const float along = eigen.eigenvalues()[1];
  if (across > criteria.max_thickness_m * criteria.max_thickness_m) return false;
  patch.normal = {eigen.eigenvectors().col(0), std::max(across, criteria.noise_floor_m * criteria.noise_floor_m)};
  if (along < criteria.min_flatness * patch.normal.variance) return false;
  Eigen::Index axis = 0;
  if (patch.normal.direction.cwiseAbs().maxCoeff(&axis) > kAlongAnAxis &&
      std::abs(patch.centroid[axis]) > kCentral * edge)
    return false;
  patch.inverse_spread = 1.0F / along;
  return patch.tilt_variance() <= criteria.max_tilt_rad * criteria.max_tilt_rad &&
         !swept_by_laser(patch, criteria, from);
}

/// The points may be no more than the column that the lasers shoot at one azimuth. On a wall at a
/// grazing angle the columns stand so far apart that each looks like a pole. Such a pole would
/// follow the sensor along the wall.
bool shot_at_one_azimuth(const Eigen::Matrix3f& covariance, const PatchCriteria& criteria, const Viewpoint& from,
                         const Patch& patch) {
  const Eigen::Vector3f ray = from.to_sensor - patch.centroid;
  const Eigen::Vector3f sideways = from.up.cross(ray);  // as long as the horizontal range
  const float least = criteria.min_pole_rad * criteria.min_pole_rad * sideways.squaredNorm();
  return sideways.dot(covariance * sideways) < least * sideways.squaredNorm();
}

/// Only an upright pole is one: rings of the scan on any surface look like slim lying ones.
bool fit_pole(const Eigen::Matrix3f& covariance, float edge, const PatchCriteria& criteria, const Viewpoint& from,
              Patch& patch) {
  const Eigen::Vector3f& up = from.up;
  if (up.dot(covariance * up) < criteria.pole_height * criteria.pole_height * edge * edge) return false;
  const Eigen::Vector3f u = up.unitOrthogonal(), v = up.cross(u);
  const float uu = u.dot(covariance * u), uv = u.dot(covariance * v), vv = v.dot(covariance * v);
  const float mean = 0.5F * (uu + vv), split = std::sqrt(0.25F * (uu - vv) * (uu - vv) + uv * uv);
  if (mean + split > criteria.pole_width * criteria.pole_width * edge * edge) return false;
  const Eigen::Vector3f sideways = patch.centroid - up.dot(patch.centroid) * up;
  if (sideways.cwiseAbs().maxCoeff() > kCentral * edge) return false;
  if (shot_at_one_azimuth(covariance, criteria, from, patch)) return false;
  // Of the wider direction. In double: the float version differs between machines.
  const auto angle = static_cast<float>(0.5 * std::atan2(double{2 * uv}, double{uu - vv}));
  const float floor = criteria.noise_floor_m * criteria.noise_floor_m;
  patch.second = {std::cos(angle) * u + std::sin(angle) * v, std::max(mean + split, floor)};
  patch.normal = {std::cos(angle) * v - std::sin(angle) * u, std::max(mean - split, floor)};
  patch.inverse_spread = 0;
  return true;
}

}  // namespace

Patch fit_patch(const Moments& m, float edge, const PatchCriteria& criteria, const Viewpoint& from) {
  if (m.count < criteria.min_points) return {};
  Patch patch;
  patch.count = m.count;
  patch.centroid = m.sum / m.count;
  patch.epoch = m.epoch_sum / m.count;
  const Eigen::Matrix3f covariance = covariance_of(m);
  if (fit_plane(covariance, edge, criteria, from, patch)) {
    patch.kind = Patch::Kind::kPlane;
    if (patch.normal.direction.dot(from.to_sensor - patch.centroid) < 0) patch.normal.direction *= -1.0F;
  } else if (fit_pole(covariance, edge, criteria, from, patch)) {
    patch.kind = Patch::Kind::kPole;
  } else {
    return {};
  }
  return patch;
}

}  // namespace cairn::odometry
