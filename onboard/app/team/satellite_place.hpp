// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "fusion/team/site_fit.hpp"
#include "hal/geo_fix.hpp"
#include "onboard/app/profile/team_profile.hpp"

namespace cairn::app {

/// Where the robot is by the satellite receiver at its LiDAR, and when that is news for its team. Pure.
class SatellitePlace {
 public:
  /// It gives nothing if the profile has no origin for satellites.
  explicit SatellitePlace(const SatelliteProfile& profile);

  /// The robot was there. Returns where its odom frame lies in the site's, when the team should know: at first, and
  /// when that is clearly better known or another, at most every ten seconds.
  [[nodiscard]] std::optional<UncertainPose> take(const GeoFix& fix, const SE3& T_odom_base);
  /// The map begins anew, in a new odom frame.
  void begin();

  /// What came of it so far.
  struct Figures {
    std::uint64_t fixes = 0, too_far = 0;      ///< that came in; that are too far from the origin
    std::optional<UncertainPose> T_site_odom;  ///< that the team was told last
  };
  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  [[nodiscard]] bool news(const UncertainPose& T, const SE3& T_odom_base) const;

  bool on_;
  double sigma_m_;
  team::SiteOrigin origin_;
  team::SiteFit fit_;
  Time told_ = Time::min();
  Figures figures_;
};

}  // namespace cairn::app
