// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/team_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace cairn::app {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kMaxLean_deg = 1.7;   // of a floor on which a robot is put down
constexpr double kMinSigma_m = 0.001;  // no measured place is better

}  // namespace

std::optional<UncertainPose> DeploymentProfile::T_site_odom() const {
  if (sigma_m == 0) return std::nullopt;
  Vector6 at, sigma;
  at << x_m, y_m, z_m, 0, 0, yaw_deg * kRadPerDeg;
  const double lean_deg = std::min(sigma_deg, kMaxLean_deg);
  sigma << sigma_m, sigma_m, sigma_m, lean_deg * kRadPerDeg, lean_deg * kRadPerDeg, sigma_deg * kRadPerDeg;
  return UncertainPose{SE3::from_xyz_rpy(at), sigma.cwiseAbs2().asDiagonal()};
}

void declare(config::Section& s, DeploymentProfile& p) {
  constexpr config::Range kSite{-100'000, 100'000};
  s.number("x_m", p.x_m, kSite, "m", "in the site's frame; with GPS: east of a place that the team agrees on");
  s.number("y_m", p.y_m, kSite, "m", "with GPS: north of it");
  s.number("z_m", p.z_m, {-10'000, 10'000}, "m", "height of the odom frame; 0 on all robots of one floor");
  s.number("yaw_deg", p.yaw_deg, {-360, 360}, "deg", "from the site's x axis, anticlockwise; with GPS: from east");
  s.number("sigma_m", p.sigma_m, {0, 1000}, "m",
           "standard deviation of each coordinate; with GPS: of the fix. 0: nothing is known of the place");
  s.number("sigma_deg", p.sigma_deg, {0.01, 180}, "deg", "standard deviation of yaw_deg; 180: it is not known");
}

void declare(config::Section& s, SatelliteProfile& p) {
  s.number("origin_latitude_deg", p.origin_latitude_deg, {-89, 89}, "deg",
           "of a place that the team agrees on, WGS 84, north is positive; both 0: satellites are not used");
  s.number("origin_longitude_deg", p.origin_longitude_deg, {-180, 180}, "deg", "of the same place; east is positive");
  s.number("sigma_m", p.sigma_m, {0.01, 1000}, "m",
           "standard deviation of the receiver, each coordinate; between high buildings it is 10 m and more");
}

void declare(config::Section& s, TeamProfile& p) {
  s.integer("id", p.id, {0, 65535}, "", "the robot's number, unique in its team; 0: it is in no team");
  s.text("socket", p.socket, "local socket, shared with the peer process (cairn-peers --socket)");
  s.integer("bytes_per_second", p.bytes_per_second, {1000, 10'000'000}, "B/s",
            "sent to all peers together, with all overhead; cairn-peers has a cap of its own below");
  s.number("match_s", p.match_s, {0.1, 60}, "s",
           "time limit of one comparison of two maps; no other task waits for it");
  s.number(
      "body_radius_m", p.body_radius_m, {0, 10}, "m",
      "of the upright cylinder around the robot: teammates keep its points out of their maps; 0: they are not told");
  s.number("body_height_m", p.body_height_m, {0, 10}, "m", "of the cylinder's top, above base_link");
  s.group("deployment", p.deployment,
          "where the robot is put down, in a metric frame that its team shares: a guess that the maps must confirm; if "
          "it is good to a voxel and half a degree, maps are merged before they overlap");
  s.group("satellites", p.satellites,
          "use the LiDAR's GPS as start pose, in place of deployment; it has priority over map matches");
  s.number("submap_m", p.submap_m, {5, 1'000'000}, "m",
           "length of the path through one submap; the map may bend between submaps");
  s.number("drift_percent", p.drift_percent, {0.01, 20}, "%", "drift of odometry per axis, of the path");
  s.number("drift_deg_per_m", p.drift_deg_per_m, {0.0001, 2}, "°/m", "drift of the heading, per metre of the path");
}

Result<void> check(const TeamProfile& profile) {
  const DeploymentProfile& d = profile.deployment;
  const DeploymentProfile none;
  std::string faults;
  const bool said = d.x_m != 0 || d.y_m != 0 || d.z_m != 0 || d.yaw_deg != 0 || d.sigma_deg != none.sigma_deg;
  if (d.sigma_m == 0 && said)
    faults = "deployment.sigma_m is missing: the standard deviation of the place; with a tape measure: 0.05";
  if (d.sigma_m != 0 && d.sigma_m < kMinSigma_m)
    faults = "deployment.sigma_m is below 0.001: no place is known to a millimetre";
  const auto fault = [&](const char* text) { faults += std::string(faults.empty() ? "" : "\n") + text; };
  if (d.sigma_m != 0 && profile.id == 0) fault("deployment is set, but id is not");
  if (profile.satellites.on() && d.sigma_m != 0) fault("deployment and satellites are both set: choose one");
  if (profile.satellites.on() && profile.id == 0) fault("satellites is set, but id is not");
  if (faults.empty()) return {};
  return Error{Errc::kInvalidConfig, "faults in the section team", {}, {}, faults};
}

team::TeamConfig team_config(const TeamProfile& profile, peers::RobotId id, const std::string& name,
                             double resolution_m) {
  team::TeamConfig config;
  config.id = id;
  config.name = name;
  config.resolution_m = resolution_m;
  config.deployment = profile.deployment.T_site_odom();
  config.exchange.bytes_per_second = static_cast<std::size_t>(profile.bytes_per_second);
  config.own_submaps = {profile.submap_m, profile.drift_percent / 100, profile.drift_deg_per_m * M_PI / 180};
  return config;
}

peers::Epoch new_epoch(Time now_utc) {
  const auto seconds = static_cast<peers::Epoch>(to_seconds(now_utc));
  return seconds << kRandomBits | std::random_device{}() >> (32U - kRandomBits);
}

}  // namespace cairn::app
