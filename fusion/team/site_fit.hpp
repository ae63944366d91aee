// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <numbers>
#include <optional>

#include "hal/se3.hpp"

namespace cairn::team {

/// A place on the earth (WGS 84) that a team agrees on: the origin of its site's frame, x east, y north, z up.
struct SiteOrigin {
  double latitude_deg = 0, longitude_deg = 0;
  /// Metres east and north of the origin, by the curvature of the ellipsoid there: to a centimetre within 2 km, to a
  /// metre within 10 km.
  [[nodiscard]] Eigen::Vector2d to_site(double latitude_deg, double longitude_deg) const;
  /// The inverse: latitude and longitude, degrees.
  [[nodiscard]] Eigen::Vector2d from_site(const Eigen::Vector2d& site) const;
};

/// Where a robot's odom frame lies in its site's, from places that a satellite receiver gave while the robot drove: the
/// rigid motion in the plane with the least squares (Umeyama 1991, without scale). A receiver's error is mostly one
/// offset that changes within minutes. So places do not average it out, but the heading is known after some metres.
class SiteFit {
 public:
  static constexpr double kApart_m = 2;            ///< a place counts where the robot is so far from the last one
  static constexpr std::size_t kMostPlaces = 128;  ///< older ones are left out
  static constexpr double kFarthest_m = 100'000;   ///< from the origin
  static constexpr double kUnknownYaw_rad = std::numbers::pi;

  /// `sigma_m`: of the receiver's offset, each coordinate.
  explicit SiteFit(double sigma_m = 3) : sigma_m_(sigma_m) {}

  /// The robot was at `odom` (metres in its odom frame) and at `site` by the receiver. False: it does not count.
  bool add(const Eigen::Vector2d& odom, const Eigen::Vector2d& site);
  void clear() { places_.clear(); }
  [[nodiscard]] std::size_t places() const { return places_.size(); }

  /// None before the first place. The standard deviation of yaw is kUnknownYaw_rad until it is below a radian. Height
  /// is taken for 0, to 10 m.
  [[nodiscard]] std::optional<UncertainPose> T_site_odom() const;

 private:
  struct Place {
    Eigen::Vector2d odom, site;
  };
  double sigma_m_;
  std::deque<Place> places_;
};

/// Standard deviation of the heading, and whether it is known at all.
[[nodiscard]] inline bool knows_yaw(const UncertainPose& T) { return T.covariance(5, 5) < 1; }

}  // namespace cairn::team
