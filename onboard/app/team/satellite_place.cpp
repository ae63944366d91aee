// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/satellite_place.hpp"

namespace cairn::app {
namespace {

constexpr Duration kPause = std::chrono::seconds(10);
constexpr double kBetter = 0.7;  // times the standard deviation of yaw that the team knows
constexpr double kMoved = 0.5;   // times the standard deviation of the place

}  // namespace

SatellitePlace::SatellitePlace(const SatelliteProfile& profile)
    : on_(profile.on()),
      sigma_m_(profile.sigma_m),
      origin_{profile.origin_latitude_deg, profile.origin_longitude_deg},
      fit_(profile.sigma_m) {}

std::optional<UncertainPose> SatellitePlace::take(const GeoFix& fix, const SE3& T_odom_base) {
  if (!on_) return std::nullopt;
  ++figures_.fixes;
  const Eigen::Vector2d site = origin_.to_site(fix.latitude_deg, fix.longitude_deg);
  if (site.norm() > team::SiteFit::kFarthest_m) ++figures_.too_far;
  if (!fit_.add(T_odom_base.translation().head<2>(), site)) return std::nullopt;
  const auto T = fit_.T_site_odom();
  const bool rests = told_ != Time::min() && fix.stamp < told_ + kPause;
  if (!T || rests || !news(*T, T_odom_base)) return std::nullopt;
  told_ = fix.stamp;
  return figures_.T_site_odom = T;
}

bool SatellitePlace::news(const UncertainPose& T, const SE3& T_odom_base) const {
  const auto& told = figures_.T_site_odom;
  if (!told) return true;
  if (T.covariance(5, 5) < kBetter * kBetter * told->covariance(5, 5)) return true;
  return ((T.mean * T_odom_base).translation() - (told->mean * T_odom_base).translation()).norm() > kMoved * sigma_m_;
}

void SatellitePlace::begin() {
  fit_.clear();
  told_ = Time::min();
  figures_.T_site_odom.reset();
}

}  // namespace cairn::app
