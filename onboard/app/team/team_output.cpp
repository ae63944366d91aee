// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/team_output.hpp"

#include <iterator>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "fusion/merging/positions_file.hpp"
#include "fusion/team/team_positions.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/mapping/files/point_file.hpp"

namespace cairn::app {
namespace {

// Voxels whose places are told: they take 0.3 GB for a moment.
constexpr std::size_t kMostPlaced = 2'000'000;

/// Where a peer's odom frame lies in this robot's by now, by all that the team knows. None where it knows nothing.
std::optional<UncertainPose> pose_of(const team::Team& team, peers::RobotId peer) {
  const team::TeamPoses& poses = team.poses();
  const peers::RobotId self = team.exchange().self();
  if (!poses.T_team_odom.contains(self) || !poses.T_team_odom.contains(peer)) return std::nullopt;
  UncertainPose pose;
  pose.mean = poses.T_team_odom.at(self).inverse() * poses.T_team_odom.at(peer);
  const auto newest = [&](peers::RobotId robot) { return std::prev(poses.nodes.upper_bound({robot, 0xFFFF})); };
  const auto own = newest(self), other = newest(peer);
  const Matrix6 covariance = team::Marginals(poses.graph).between(own->second, other->second).covariance;
  const Matrix6 at_odom = (poses.T_team_odom.at(peer).inverse() * poses.graph.poses[other->second]).adjoint();
  pose.covariance = at_odom * covariance * at_odom.transpose();
  return pose;
}

std::string name_of(const team::Team& team, peers::RobotId robot) {
  const auto link = team.exchange().links().find(robot);
  const bool named = link != team.exchange().links().end() && !link->second.name.empty();
  return named ? link->second.name : "robot " + std::to_string(robot);
}

std::size_t tiles_of(const team::Team& team, peers::RobotId robot) {
  const auto layer = team.exchange().layers().find(robot);
  if (layer == team.exchange().layers().end()) return 0;
  std::size_t tiles = 0;
  for (const auto& [id, item] : layer->second.holding.items()) tiles += id.kind() == peers::ItemKind::kTile ? 1 : 0;
  return tiles;
}

report::PeerStats stats_of(const TeamTask& task, peers::RobotId robot) {
  const team::Team& team = *task.team();
  report::PeerStats stats;
  if (const auto link = team.exchange().links().find(robot); link != team.exchange().links().end()) {
    stats.tx_bytes = link->second.sent_bytes;
    stats.people_tx_bytes = link->second.sent_bodies_bytes;
    stats.rx_bytes = link->second.received_bytes;
  }
  if (const auto lag = task.lags().find(robot); lag != task.lags().end() && lag->second.count() > 0)
    stats.age_p99_s = to_seconds(lag->second.percentile(0.99));
  const team::PeerStanding standing = team.standing(robot, task.last_step());
  stats.tiles = tiles_of(team, robot);
  stats.accepted = standing.merged();
  stats.state = to_string(standing.state);
  stats.reason = standing.reason;
  stats.deployment_contradicted = standing.deployment_contradicted;
  stats.T_map_peer = pose_of(team, robot);
  return stats;
}

}  // namespace

void add_team(const TeamTask& task, report::RunReport& report) {
  if (!task.team()) return;
  const team::Team& team = *task.team();
  const peers::RobotId self = team.exchange().self();
  report::TeamStats stats;
  stats.id = self;
  stats.anchor = team.poses().anchor;
  stats.T_team_odom = team.poses().T_team_odom;
  for (const auto& [robot, layer] : team.exchange().layers()) {
    if (robot == self) continue;
    std::string name = name_of(team, robot);
    if (report.peers.contains(name)) name += " (" + std::to_string(robot) + ")";
    report.peers.emplace(name, stats_of(task, robot));
    if (team.poses().T_team_odom.contains(robot)) stats.merged_with.push_back(name);
  }
  stats.tiles = tiles_of(team, self);
  stats.held_back_times = team.held_back().times;
  stats.held_back_s = to_seconds(team.held_back().time);
  stats.held_back_tiles = team.held_back().tiles;
  stats.satellite_fixes = task.satellites().figures().fixes;
  stats.T_site_odom = task.satellites().figures().T_site_odom;
  report.team = std::move(stats);
}

Result<TeamFiles> write_team(const team::Team& team, const std::filesystem::path& out) {
  const auto [map, tum, tree, places] = kTeamFiles;
  TeamFiles files{.same = {out / map, out / tum}, .positions = {}};
  std::vector<recording::StampedPose> poses;
  for (const auto& [robot, T_team_odom] : team.poses().T_team_odom)
    poses.push_back({Time{} + std::chrono::seconds(static_cast<std::int64_t>(robot)), T_team_odom});
  if (const auto saved = mapping::save_cairn(team.map().map(), files.same[0]); !saved) return saved.error();
  if (const auto saved = recording::write_tum(files.same[1], poses); !saved) return saved.error();
  if (const auto saved = mapping::save_ot(team.map().map(), out / tree); !saved) return saved.error();
  const bool alone = team.poses().T_team_odom.size() < 2;
  if (alone || !mapping::listable_voxels(team.map().map(), kMostPlaced)) return files;
  const auto positions = team::team_positions(team);
  if (!positions) return positions.error();
  if (const auto saved = merging::save_positions(*positions, out / places); !saved) return saved.error();
  files.positions = merging::position_figures(*positions);
  return files;
}

}  // namespace cairn::app
