// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/placing.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace cairn::app {
namespace {

constexpr double kHeightSigma_m = 1;
constexpr double kLeanSigma_rad = 1.7 * std::numbers::pi / 180;  // of a floor on which robots stand

double yaw_of(const SE3& T) {
  const Eigen::Vector3d x = T.rotation().col(0);
  return std::atan2(x.y(), x.x());
}

Error nobody(const std::string& name) {
  return {Errc::kNotFound, "no teammate of this name was heard of", name, {}, "`cairn doctor --peer all` lists them"};
}

/// The robot whose odom the team's map is in: the lowest one of those that are merged.
Result<peers::RobotId> first_of(const team::Team& team) {
  const auto& poses = team.poses().T_team_odom;
  if (!poses.empty() && poses.begin()->first != team.exchange().self()) return poses.begin()->first;
  return Error{Errc::kNotFound, "the frame of the team's map is this robot's own odom", {}, {}, "name a teammate"};
}

}  // namespace

UncertainPose T_frame_odom(const clients::Placement& place, const SE3& T_odom_base) {
  const double turn = place.yaw - yaw_of(T_odom_base);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix() * T_odom_base.rotation();
  const SE3 T_frame_base(Eigen::Quaterniond(R), {place.x, place.y, T_odom_base.translation().z()});
  Vector6 sigma;
  sigma << place.sigma_m, place.sigma_m, kHeightSigma_m, kLeanSigma_rad, kLeanSigma_rad, place.sigma_rad;
  // The map around the robot is as sure of base_link as it can be.
  return compose({T_frame_base, sigma.cwiseAbs2().asDiagonal()}, {T_odom_base.inverse(), Matrix6::Zero()});
}

std::string to_string(const clients::Placement& place) {
  if (place.takes_back()) return "what was said of its place is taken back";
  char text[100];
  std::snprintf(text, sizeof text, "it was placed at (%.2f, %.2f), %.0f degrees, in ", place.x, place.y,
                place.yaw * 180 / std::numbers::pi);
  if (place.frame.empty()) return text + std::string("the frame of start poses");
  if (place.frame.view() == clients::Placement::kTeam) return text + std::string("the team's map");
  return text + std::string("odom of ").append(place.frame.view());
}

Result<peers::RobotId> robot_of_frame(const clients::Placement& place, const team::Team& team) {
  if (place.frame.empty()) return 0;
  if (place.frame.view() == clients::Placement::kTeam) return first_of(team);
  for (const auto& [robot, link] : team.exchange().links())
    if (link.name == place.frame.view()) return robot;
  return nobody(std::string(place.frame.view()));
}

}  // namespace cairn::app
