// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/profile/team_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace cairn::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180, kMostLeanDeg = 1.7, kLeastSigmaM = 0.001;

}  // namespace

std::optional<UncertainPose> DeploymentProfile::T_site_odom() const {
  if (sigma_m == 0) return std::nullopt;
  Vector6 at, sigma;
  at << x_m, y_m, z_m, 0, 0, yaw_deg * kDegree;
  const double lean_deg = std::min(sigma_deg, kMostLeanDeg);
  sigma << sigma_m, sigma_m, sigma_m, lean_deg * kDegree, lean_deg * kDegree, sigma_deg * kDegree;
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

void declare(config::Section& s, TeamProfile& p) {
  s.integer("id", p.id, {0, 65535}, "", "the robot's number in its team, its own there; 0: it is in none");
  s.text("socket", p.socket, "local socket that it shares with its peer process (cairn-peers --socket)");
  s.integer("bytes_per_second", p.bytes_per_second, {1000, 10'000'000}, "B/s",
            "what it tells others, all overhead included; cairn-peers has a cap of its own below");
  s.number("match_s", p.match_s, {0.1, 60}, "s", "one comparison of two maps may take so long; it holds up nothing");
  s.group("deployment", p.deployment,
          "where the robot is put down, in a metric frame that its team shares: a guess for finding the others, which "
          "their maps must confirm; with less than a voxel and half a degree it merges maps before they overlap");
  s.number("submap_m", p.submap_m, {5, 1'000'000}, "m", "path after which its map may bend: a new submap begins");
  s.number("drift_percent", p.drift_percent, {0.01, 20}, "%", "of the path that odometry may be off, per axis");
  s.number("drift_deg_per_m", p.drift_deg_per_m, {0.0001, 2}, "°/m", "of the path that odometry may be turned");
}

Result<void> check(const TeamProfile& profile) {
  const DeploymentProfile& d = profile.deployment;
  const DeploymentProfile none;
  std::string faults;
  const bool said = d.x_m != 0 || d.y_m != 0 || d.z_m != 0 || d.yaw_deg != 0 || d.sigma_deg != none.sigma_deg;
  if (d.sigma_m == 0 && said) faults = "deployment.sigma_m is missing: how far may the place be off? A tape: 0.05";
  if (d.sigma_m != 0 && d.sigma_m < kLeastSigmaM) faults = "deployment.sigma_m: nobody knows it to a millimetre";
  if (d.sigma_m != 0 && profile.id == 0) faults += std::string(faults.empty() ? "" : "\n") + "deployment without id";
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
