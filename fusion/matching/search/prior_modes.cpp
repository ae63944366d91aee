// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/prior_modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fusion/matching/features/sample.hpp"
#include "fusion/matching/features/structure.hpp"
#include "fusion/matching/search/coarse_search.hpp"

namespace cairn::matching {
namespace {

constexpr std::size_t kSearchPoints = 2000;
constexpr int kModes = 60, kWideModes = 48;
constexpr double kWindowSigmas = 3, kMinWindowM = 0.8, kMaxWindowM = 20, kMaxHeightM = 4, kMinYaw = 0.07;
constexpr double kMarginM = 0.4, kMarginYaw = 0.1;  // of a window: a cell of the search, and what that is at 4 m
constexpr double kOneHeightM = 0.5;  // a prior that knows the height better than this needs no search over it
constexpr double kWideYaw = 1.0;

std::vector<Eigen::Vector3f> points_of(std::span<const Surfel> surfels) {
  std::vector<Eigen::Vector3f> points(surfels.size());
  std::transform(surfels.begin(), surfels.end(), points.begin(), [](const Surfel& s) { return s.point; });
  return points;
}

/// Three standard deviations of the prior, within what a search can cover. Positions are of the source's origin.
SearchWindow window_of(const UncertainPose& prior) {
  const Eigen::Matrix3d R = prior.mean.rotation();
  const Eigen::Matrix3d position = R * prior.covariance.topLeftCorner<3, 3>() * R.transpose();
  const double xy = std::sqrt(
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(position.topLeftCorner<2, 2>()).eigenvalues().maxCoeff());
  const double z = std::sqrt(std::max(0.0, position(2, 2)));
  SearchWindow window;
  window.xy_m = std::clamp(kWindowSigmas * xy, kMinWindowM, kMaxWindowM);
  window.z_m = z > kOneHeightM ? std::min(kWindowSigmas * z, kMaxHeightM) : 0;
  window.yaw_rad = std::clamp(kWindowSigmas * std::sqrt(prior.covariance(5, 5)), kMinYaw, M_PI);
  return window;
}

}  // namespace

bool within(const UncertainPose& prior, const SE3& T) {
  const SearchWindow window = window_of(prior);
  const Eigen::Vector2d moved = (T.translation() - prior.mean.translation()).head<2>();
  return moved.cwiseAbs().maxCoeff() <= window.xy_m + kMarginM &&
         rotation_angle(prior.mean.inverse() * T) <= window.yaw_rad + kMarginYaw;
}

PriorModes::PriorModes(const MapFeatures& a, const MapFeatures& b)
    : structure_a_(points_of(structure_of(a.coarse()))),
      structure_b_(sample(std::span<const Eigen::Vector3f>(points_of(structure_of(b.coarse()))), kSearchPoints)),
      cell_m_(std::max({0.4F, a.coarse_m(), b.coarse_m()})) {}

std::vector<SE3> PriorModes::near(const UncertainPose& prior) const {
  const SearchWindow window = window_of(prior);
  const LikelihoodField field(structure_a_, cell_m_, window);
  std::vector<SE3> poses;
  const int modes = window.yaw_rad > kWideYaw ? kWideModes : kModes;
  for (const Mode& mode : search(field, structure_b_, prior.mean, window, modes)) poses.push_back(mode.T_target_source);
  return poses;
}

}  // namespace cairn::matching
