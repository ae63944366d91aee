// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/refinements.hpp"

#include <Eigen/Geometry>
#include <vector>

namespace cairn::team {
namespace {

constexpr std::size_t kLeastCommon = 25;  // tiles: two walls of a corridor, 10 m long, in voxels of 0.2 m
constexpr double kMore = 1.5;             // times as many tiles as when it was compared

/// A ball around the walls of a submap: team's frame, metres.
struct Ball {
  Eigen::Vector3d centre;
  double radius;
};

Ball around(const RobotTiles::Tiles& walls, const SE3& T_team_odom, double tile_m) {
  Eigen::AlignedBox3d box;
  for (const mapping::TileKey tile : walls)
    box.extend(tile_m * Eigen::Vector3d(tile.first_voxel(0) / 8 - 4096, tile.first_voxel(1) / 8 - 4096,
                                        tile.first_voxel(2) / 8 - 4096));
  return {T_team_odom * box.center(), 0.5 * box.diagonal().norm() + 2 * tile_m};
}

struct Submap {
  std::uint16_t index;
  const RobotTiles::Tiles* walls;
  SE3 T_team_odom;
  Ball ball;
};

std::vector<Submap> placed_submaps(peers::RobotId robot, const RobotTiles& tiles, const TeamPoses& poses,
                                   double tile_m) {
  std::vector<Submap> submaps;
  for (const auto& [index, walls] : tiles.walls_by_submap()) {
    const auto pose = poses.submaps.find({robot, index});
    if (pose == poses.submaps.end()) continue;
    submaps.push_back(
        {.index = index, .walls = &walls, .T_team_odom = pose->second, .ball = around(walls, pose->second, tile_m)});
  }
  return submaps;
}

struct Overlap {
  std::uint16_t own, other;
  std::size_t common;
};

std::vector<Overlap> overlaps(const std::vector<Submap>& own, const std::vector<Submap>& other, double tile_m) {
  std::vector<Overlap> all;
  for (const Submap& a : own)
    for (const Submap& b : other) {
      if ((a.ball.centre - b.ball.centre).norm() > a.ball.radius + b.ball.radius) continue;
      const std::size_t common = common_tiles(*a.walls, *b.walls, b.T_team_odom.inverse() * a.T_team_odom, tile_m);
      if (common >= kLeastCommon) all.push_back({.own = a.index, .other = b.index, .common = common});
    }
  return all;
}

/// Whether one of the two submaps has no more in common with any other.
bool best_of_one(const Overlap& overlap, const std::vector<Overlap>& all) {
  bool own = true, other = true;
  for (const Overlap& o : all) {
    own = own && (o.own != overlap.own || o.common <= overlap.common);
    other = other && (o.other != overlap.other || o.common <= overlap.common);
  }
  return own || other;
}

}  // namespace

std::optional<SubmapPair> Refinements::next(peers::RobotId self, peers::RobotId peer, const RobotTiles& own,
                                            const RobotTiles& other, const TeamPoses& poses, double tile_m) {
  const auto own_submaps = placed_submaps(self, own, poses, tile_m),
             other_submaps = placed_submaps(peer, other, poses, tile_m);
  if (own_submaps.size() < 2 && other_submaps.size() < 2) return std::nullopt;  // the whole maps are compared anyway
  const auto all = overlaps(own_submaps, other_submaps, tile_m);
  const Overlap* best = nullptr;
  for (const Overlap& overlap : all) {
    const auto before = compared_.find({peer, overlap.own, overlap.other});
    const bool grown = before == compared_.end()
                           ? compared_.size() < kEdgesPerOrigin
                           : static_cast<double>(overlap.common) >= kMore * static_cast<double>(before->second.common);
    if (grown && (best == nullptr || overlap.common > best->common) && best_of_one(overlap, all)) best = &overlap;
  }
  if (best == nullptr) return std::nullopt;
  const SubmapPair pair{.peer = peer, .own = best->own, .other = best->other};
  const PublishedEdge edge(edge_index(EdgeOrigin::kRefined, compared_.size()));
  compared_.try_emplace(pair, Comparison{0, edge}).first->second.common = best->common;
  return pair;
}

PublishedEdge* Refinements::edge(const SubmapPair& pair) {
  const auto found = compared_.find(pair);
  return found == compared_.end() ? nullptr : &found->second.edge;
}

void Refinements::forget(peers::RobotId peer) {
  for (auto& [pair, comparison] : compared_)
    if (pair.peer == peer) comparison = {0, PublishedEdge(comparison.edge.index())};
}

}  // namespace cairn::team
