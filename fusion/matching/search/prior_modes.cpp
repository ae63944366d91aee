// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/prior_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fusion/matching/features/sample.hpp"
#include "fusion/matching/features/structure.hpp"
#include "fusion/matching/search/coarse_search.hpp"
#include "hal/symmetric_eigen.hpp"

namespace cairn::matching {
namespace {

std::vector<Eigen::Vector3f> points_of(std::span<const Surfel> surfels) {
  std::vector<Eigen::Vector3f> points(surfels.size());
  std::transform(surfels.begin(), surfels.end(), points.begin(), [](const Surfel& s) { return s.point; });
  return points;
}

constexpr double kRounded = 1e-9;  // m² or rad²: rounding may put a variance of zero so far below it

/// What is no variance, because it is negative or not a number, says nothing: infinity.
double deviation_of(double variance) {
  return variance >= -kRounded ? std::sqrt(std::max(0.0, variance)) : std::numeric_limits<double>::infinity();
}

/// The prior's standard deviations, within what a search can cover. Positions are of the source's
/// origin.
SearchWindow window_of(const UncertainPose& prior, const CoarseSearchConfig& config) {
  const Eigen::Matrix3d R = prior.mean.rotation();
  const Eigen::Matrix3d position = R * prior.covariance.topLeftCorner<3, 3>() * R.transpose();
  const double xy = deviation_of(symmetric_eigenvalues(position.topLeftCorner<2, 2>()).maxCoeff());
  const double z = deviation_of(position(2, 2));
  SearchWindow window;
  window.xy_m = std::clamp(config.sigmas * xy, config.least_xy_m, config.most_xy_m);
  window.z_m = z > config.one_height_m ? std::min(config.sigmas * z, config.most_z_m) : 0;
  window.yaw_rad = std::clamp(config.sigmas * deviation_of(prior.covariance(5, 5)), config.least_yaw_rad, M_PI);
  return window;
}

}  // namespace

bool within(const UncertainPose& prior, const SE3& T, const CoarseSearchConfig& config) {
  const SearchWindow window = window_of(prior, config);
  const Eigen::Vector2d moved = (T.translation() - prior.mean.translation()).head<2>();
  return moved.cwiseAbs().maxCoeff() <= window.xy_m + config.margin_m &&
         rotation_angle(prior.mean.inverse() * T) <= window.yaw_rad + config.margin_rad;
}

PriorModes::PriorModes(const MapFeatures& a, const MapFeatures& b, const CoarseSearchConfig& config)
    : config_(config),
      structure_a_(points_of(structure_of(a.coarse()))),
      structure_b_(sample(std::span<const Eigen::Vector3f>(points_of(structure_of(b.coarse()))), config.points)),
      cell_m_(std::max({config.cell_m, a.coarse_m(), b.coarse_m()})) {}

std::vector<SE3> PriorModes::near(const UncertainPose& prior) const {
  const SearchWindow window = window_of(prior, config_);
  const LikelihoodField field(structure_a_, cell_m_, window);
  std::vector<SE3> poses;
  const int modes = window.yaw_rad > config_.wide_yaw_rad ? config_.wide_modes : config_.modes;
  for (const Mode& mode : search(field, structure_b_, prior.mean, window, modes)) poses.push_back(mode.T_target_source);
  return poses;
}

}  // namespace cairn::matching
