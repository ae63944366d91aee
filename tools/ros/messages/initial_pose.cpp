// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/initial_pose.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::ros {
namespace {

using clients::Placement;

/// The name of the frame in a command; nothing for the robot's own odom.
std::optional<std::string_view> frame_from(std::string_view frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);
  if (frame == "map" || frame == "site") return "";
  if (frame == "odom") return std::nullopt;
  if (frame.ends_with("/odom")) frame.remove_suffix(std::string_view("/odom").size());
  return frame.empty() ? std::nullopt : std::optional(frame);
}

double sigma_of(double variance, double otherwise, double least) {
  return variance > 0 ? std::max(std::sqrt(variance), least) : otherwise;
}

}  // namespace

std::optional<Placement> placement_from(const PoseWithCovarianceStamped& message, std::string_view& why) {
  const auto frame = frame_from(message.header.frame_id == nullptr ? "" : message.header.frame_id);
  if (!frame) {
    why = "its frame must be team, map, or odom of a teammate, such as robot_1/odom";
    return std::nullopt;
  }
  const auto& [pose, covariance] = message.pose;
  const auto& q = pose.orientation;
  Placement place{.frame = clients::ShortText<32>(*frame), .x = pose.position.x, .y = pose.position.y};
  place.yaw = std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
  place.sigma_m = sigma_of(std::max(covariance[0], covariance[7]), kGuessedSigma_m, Placement::kLeastSigma_m);
  place.sigma_rad = sigma_of(covariance[35], kGuessedSigma_rad, Placement::kLeastSigma_rad);
  place.sigma_rad = std::min(place.sigma_rad, 3.14);
  const double length = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (place.possible() && std::abs(length - 1) < 0.01) return place;
  why = "it is no possible pose";
  return std::nullopt;
}

}  // namespace cairn::ros
