// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/team_figures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/team/figures/map_overlap.hpp"

namespace cairn::team_run {
namespace {

constexpr double kDegrees = 57.29577951308232;

const RobotResult* find(const std::vector<RobotResult>& robots, const std::string& name) {
  const auto found = std::ranges::find(robots, name, &RobotResult::name);
  return found == robots.end() ? nullptr : &*found;
}

bool claims(const RobotResult& robot, const RobotResult& other) {
  return std::ranges::find(robot.merged_with, other.name) != robot.merged_with.end();
}

/// By how much it is wrong where `other` is, as `robot` sees it; none where truth or pose is not known.
std::optional<SE3> error_between(const RobotResult& robot, const RobotResult& other) {
  const auto pose = robot.T_map_peer.find(other.name);
  if (pose == robot.T_map_peer.end() || !robot.standing || !other.standing) return std::nullopt;
  return sight_error(*robot.standing, *other.standing, pose->second);
}

std::optional<double> iou_of(const std::vector<RobotResult>& robots, const RobotResult& robot,
                             const mapping::SemanticOcTree* world) {
  const RobotResult* anchor = find(robots, robot.anchor);
  if (world == nullptr || robot.team_map == nullptr || anchor == nullptr || !anchor->standing) return std::nullopt;
  return iou_with_world(*robot.team_map, anchor->standing->T_world_odom() * anchor->T_team_odom.inverse(), *world);
}

RobotFigures figures_of(const std::vector<RobotResult>& robots, const RobotResult& robot,
                        const mapping::SemanticOcTree* world) {
  RobotFigures figures;
  figures.name = robot.name;
  figures.team_sha256 = robot.team_sha256;
  figures.merged_with = robot.merged_with;
  figures.iou_world = iou_of(robots, robot, world);
  figures.ticks = robot.ticks;
  figures.missed_ticks = robot.missed_ticks;
  for (const auto& [name, reason] : robot.reasons)
    if (std::ranges::find(robot.merged_with, name) == robot.merged_with.end()) figures.not_merged[name] = reason;
  for (const std::string& name : robot.merged_with) {
    const RobotResult* other = find(robots, name);
    const auto error = other != nullptr ? error_between(robot, *other) : std::nullopt;
    figures.pose_error_m.push_back(error ? std::optional(error->translation().norm()) : std::nullopt);
    figures.pose_error_deg.push_back(error ? std::optional(rotation_angle(*error) * kDegrees) : std::nullopt);
  }
  return figures;
}

template <class Visit>
void for_each_merged_pair(const std::vector<RobotResult>& robots, Visit&& visit) {
  for (auto a = robots.begin(); a != robots.end(); ++a)
    for (auto b = std::next(a); b != robots.end(); ++b)
      if (claims(*a, *b) || claims(*b, *a)) visit(*a, *b);
}

std::optional<std::size_t> count_wrong_merges(const std::vector<RobotResult>& robots) {
  if (!std::ranges::all_of(robots, [](const RobotResult& r) { return r.standing.has_value(); })) return std::nullopt;
  std::size_t wrong = 0;
  for_each_merged_pair(robots, [&](const RobotResult& a, const RobotResult& b) {
    const auto seen_by_a = error_between(a, b), seen_by_b = error_between(b, a);
    wrong += (seen_by_a && is_wrong_merge(*seen_by_a)) || (seen_by_b && is_wrong_merge(*seen_by_b)) ? 1U : 0U;
  });
  return wrong;
}

/// "robot_1 lacks 2 of robot_3's 341 tiles"; empty where it lacks none.
std::string lack(const RobotResult& holder, const RobotResult& of) {
  const auto held = holder.tiles_of_peer.find(of.name);
  if (holder.name == of.name || !of.own_tiles || held == holder.tiles_of_peer.end() || held->second >= *of.own_tiles)
    return {};
  return fmt::format("{} lacks {} of {}'s {} tiles", holder.name, *of.own_tiles - held->second, of.name, *of.own_tiles);
}

std::string why_they_differ(const std::vector<RobotResult>& robots, const RobotResult& a, const RobotResult& b) {
  std::string lacks;
  for (const RobotResult& of : robots)
    for (const RobotResult* holder : {&a, &b})
      if (const std::string text = lack(*holder, of); !text.empty()) lacks += (lacks.empty() ? "" : ", ") + text;
  if (!lacks.empty())
    return lacks + ": they had not arrived at the end; try a longer --settle, or a --link that carries more";
  return "no tile is missing: the robots had not yet fused the newest poses (try a longer --settle), or it is a fault";
}

}  // namespace

std::size_t in_largest_team(const std::vector<RobotResult>& robots) {
  const auto size = [](const RobotResult& robot) { return robot.merged_with.size(); };
  return static_cast<std::size_t>(std::ranges::max_element(robots, {}, size) - robots.begin());
}

TeamFigures compare_team(const std::vector<RobotResult>& robots, const mapping::SemanticOcTree* world) {
  TeamFigures figures;
  for (const RobotResult& robot : robots) figures.robots.push_back(figures_of(robots, robot, world));
  figures.wrong_merges = count_wrong_merges(robots);
  if (!robots.empty()) figures.iou_world = figures.robots[in_largest_team(robots)].iou_world;
  for_each_merged_pair(robots, [&](const RobotResult& a, const RobotResult& b) {
    if (a.team_sha256 == b.team_sha256) return;
    figures.disagreements.push_back(a.name + " and " + b.name);
    figures.disagreement_hints.push_back(why_they_differ(robots, a, b));
  });
  return figures;
}

}  // namespace cairn::team_run
