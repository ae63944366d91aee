// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/se3.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/odometry/registration.hpp"

namespace cairn::odometry {

/// What a scan told about a robot that was restarted.
enum class Relocalisation : std::uint8_t {
  kNotNeeded,  ///< the robot was not restarted, or it was found before
  kUndecided,  ///< the scan has too few points to tell; the next one is asked
  kFound,      ///< the robot is where the previous run ended, or some metres farther on
  kElsewhere,  ///< the scan does not fit there: the robot was carried away
};
[[nodiscard]] std::string_view to_string(Relocalisation answer);

/// After a restart: expects the robot where the previous run ended, and says from the first scan
/// whether it is there.
///
/// The robot has come to rest since, or nearly. Its motors' own watchdog stops it at most a third
/// of a second after its pose was saved. A wider search would find more places that look alike: a
/// car park repeats every 2.5 m.
class Relocaliser {
 public:
  explicit Relocaliser(const OdometryConfig& config);

  /// A previous run ended at `T_odom_base` with this `twist` (m/s, rad/s). Returns the uncertainty
  /// of a robot that stands near there.
  [[nodiscard]] MotionFilter::Uncertainty expect(const UncertainPose& T_odom_base, const Vector6& twist);
  /// How much of the previous run's own last scan lies on known surfaces, 0…1. The first scan is
  /// compared with it.
  void compare_with(double known_share);
  /// The first scan after expect() that tells is still to come.
  [[nodiscard]] bool pending() const { return expected_.has_value(); }

  /// A robot without its program comes to rest: while pending(), a longer time than `coasting_s`
  /// takes it no farther.
  [[nodiscard]] double moving_time_s(double dt_s) const;
  /// Judges the fit of a scan with so many keypoints. Ends pending(), unless kUndecided.
  [[nodiscard]] Relocalisation judge(const Fit& fit, std::size_t keypoints);

 private:
  struct Expected {
    SE3 T_odom_base;         // where the previous run ended
    double farthest_m = 0;   // that the base may have come since
    double known_share = 0;  // of the previous run's last scan
  };
  [[nodiscard]] bool fits(const Fit& fit, std::size_t keypoints) const;

  RestartConfig config_;
  int min_matches_;
  std::optional<Expected> expected_;
};

}  // namespace cairn::odometry
