// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/site_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cairn::team {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kAxis_m = 6'378'137, kEccentricity2 = 0.00669437999014;  // WGS 84
constexpr double kHeightSigma_m = 10;
constexpr double kLeanSigma_rad = 1.7 * kRadPerDeg;  // odom frames are level as a floor is
// A receiver's error from one place to the next, at least. A consumer's receiver has 0.5 to 1 m.
constexpr double kLeastNoise_m = 1;
// Errors of places that follow each other are alike: four say about as much as one.
constexpr double kAlike = 4;

/// Of the ellipsoid at a latitude.
struct Radii {
  double meridian_m, normal_m;
};

Radii radii_at(double latitude_deg) {
  const double sine = std::sin(latitude_deg * kRadPerDeg), w2 = 1 - kEccentricity2 * sine * sine;
  return {kAxis_m * (1 - kEccentricity2) / (w2 * std::sqrt(w2)), kAxis_m / std::sqrt(w2)};
}

}  // namespace

Eigen::Vector2d SiteOrigin::from_site(const Eigen::Vector2d& site) const {
  const auto [meridian_m, normal_m] = radii_at(latitude_deg);
  const double latitude = latitude_deg + site.y() / meridian_m / kRadPerDeg;
  const double middle = 0.5 * (latitude + latitude_deg) * kRadPerDeg;
  return {latitude, longitude_deg + site.x() / (normal_m * std::cos(middle)) / kRadPerDeg};
}

Eigen::Vector2d SiteOrigin::to_site(double latitude, double longitude) const {
  const auto [meridian_m, normal_m] = radii_at(latitude_deg);
  const double east = std::remainder(longitude - longitude_deg, 360) * kRadPerDeg;
  const double middle = 0.5 * (latitude + latitude_deg) * kRadPerDeg;
  return {normal_m * std::cos(middle) * east, meridian_m * (latitude - latitude_deg) * kRadPerDeg};
}

bool SiteFit::add(const Eigen::Vector2d& odom, const Eigen::Vector2d& site) {
  if (!site.allFinite() || site.norm() > kFarthest_m) return false;
  if (!places_.empty() && (odom - places_.back().odom).norm() < kApart_m) return false;
  places_.push_back({odom, site});
  if (places_.size() > kMostPlaces) places_.pop_front();
  return true;
}

std::optional<UncertainPose> SiteFit::T_site_odom() const {
  if (places_.empty()) return std::nullopt;
  const double n = static_cast<double>(places_.size());
  Eigen::Vector2d odom = Eigen::Vector2d::Zero(), site = Eigen::Vector2d::Zero();
  for (const Place& p : places_) {
    odom += p.odom / n;
    site += p.site / n;
  }
  double along = 0, across = 0, spread = 0, site_spread = 0;
  for (const Place& p : places_) {
    const Eigen::Vector2d a = p.odom - odom, b = p.site - site;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
    spread += a.squaredNorm();
    site_spread += b.squaredNorm();
  }
  const double squares = std::max(0.0, spread + site_spread - 2 * std::hypot(along, across));
  const double noise = std::max(kLeastNoise_m, n > 2 ? std::sqrt(squares / (2 * n - 3)) : 0);
  const double sigma_yaw = spread > 0 ? noise * std::sqrt(kAlike / spread) : kUnknownYaw_rad;
  const bool known = sigma_yaw < 1;
  Vector6 at = Vector6::Zero(), sigma;
  at << site, 0, 0, 0, known ? std::atan2(across, along) : 0;
  sigma << sigma_m_, sigma_m_, kHeightSigma_m, kLeanSigma_rad, kLeanSigma_rad, known ? sigma_yaw : kUnknownYaw_rad;
  const SE3 T_middle_odom(Eigen::Quaterniond::Identity(), {-odom.x(), -odom.y(), 0});
  return compose({SE3::from_xyz_rpy(at), sigma.cwiseAbs2().asDiagonal()}, {T_middle_odom, Matrix6::Zero()});
}

}  // namespace cairn::team
