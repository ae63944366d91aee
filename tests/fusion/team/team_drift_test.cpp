// SPDX-License-Identifier: Apache-2.0
// Two robots on a long ride through an office, of which one drifts: in one piece, its map smears over the other's; in
// submaps, each piece lies where it belongs.
#include <gtest/gtest.h>

#include <cmath>

#include "fusion/merging/team_map.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "fusion/team/team.hpp"
#include "tests/fusion/team/fleet/ride.hpp"

namespace cairn::team {
namespace {

using fleet::Ride;
using peers::RobotId;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kEndless = 1e9;  // metres of a submap
constexpr int kLate = 10;         // scans: the last ones

/// What one robot has said, where the team puts it.
merging::TeamMap share_of(RobotId robot, const Team& team) {
  merging::TeamMap map(0.2, merging::Policy::kRelativeEntropy);
  for (const auto& [id, item] : team.exchange().layers().at(robot).holding.items())
    if (id.kind() == peers::ItemKind::kTile)
      map.put({robot, id.submap()}, id.tile(), peers::decode_tile(item.payload).value(), Time{});
  auto poses = team.poses().submaps;
  std::erase_if(poses, [robot](const auto& pose) { return pose.first.robot != robot; });
  map.place(poses);
  Budget all = Budget::steps(1'000'000);
  EXPECT_TRUE(map.fuse(all));
  return map;
}

/// Whether the map holds something occupied around a point, as far as so many voxels.
bool wall_near(const mapping::SemanticOcTree& map, const octomap::point3d& point, int voxels) {
  const auto step = static_cast<float>(map.getResolution());
  for (int x = -voxels; x <= voxels; ++x)
    for (int y = -voxels; y <= voxels; ++y) {
      const mapping::SemanticNode* node =
          map.search(point + octomap::point3d(static_cast<float>(x) * step, static_cast<float>(y) * step, 0));
      if (node != nullptr && map.isNodeOccupied(node)) return true;
    }
  return false;
}

/// Of the walls that both have within 1.2 m of each other, the share that is doubled: not within a voxel.
double doubled(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b) {
  double apart = 0, all = 0;
  for (auto leaf = a.begin_leafs(), end = a.end_leafs(); leaf != end; ++leaf) {
    const bool wall = a.isNodeOccupied(*leaf) && leaf.getZ() > 0.4 && leaf.getZ() < 2.2;
    if (!wall || !wall_near(b, leaf.getCoordinate(), 6)) continue;
    all += 1;
    apart += wall_near(b, leaf.getCoordinate(), 1) ? 0 : 1;
  }
  return apart / all;
}

struct Figures {
  double late_m = 0;  // mean error of where the first robot sees the second, in the last scans of the ride
  double doubled = 0;
  std::size_t submaps = 0;
};

double error_m(Ride& ride) {
  const auto& poses = ride.at(1).team.poses().T_team_odom;
  EXPECT_TRUE(poses.contains(2));
  if (!poses.contains(2)) return 0;
  const auto base = [&](RobotId id) { return poses.at(id) * ride.at(id).T_odom_world() * ride.at(id).T_world_base(); };
  const SE3 truth = ride.at(1).T_world_base().inverse() * ride.at(2).T_world_base();
  return (truth.inverse() * base(1).inverse() * base(2)).translation().norm();
}

Figures after_the_ride(double submap_m, const fleet::Drift& drift, int scans) {
  TeamConfig config;
  config.own_submaps.length_m = submap_m;
  config.own_tiles.settled = seconds(4);
  Ride ride(support::office(), {{0, 0.7}, {0.5, 2.0, drift}}, {0, 0, 0, milliseconds(20), milliseconds(100)}, config);
  Figures figures;
  for (int i = 0; i < scans; ++i) {
    ride.run(1, 0.055, seconds(2));
    if (i >= scans - kLate) figures.late_m += error_m(ride) / kLate;
  }
  ride.run(0, 0, seconds(30));
  const Team& team = ride.at(1).team;
  figures.doubled = doubled(share_of(2, team).map(), share_of(1, team).map());
  figures.submaps = team.poses().submaps.size();
  EXPECT_EQ(ride.at(2).team.poses().submaps.size(), figures.submaps);
  return figures;
}

TEST(FullTeamDrift, PiecesLieWhereTheyBelong) {
  const Figures parts = after_the_ride(25, {0.015, 0.0007}, 66);
  EXPECT_GT(parts.submaps, 2U);
  EXPECT_LT(parts.doubled, 0.025);
  EXPECT_LT(parts.late_m, 0.75);
}

TEST(FullTeamDrift, WallsThatTwoHaveSeenAreNotDoubled) {
  const fleet::Drift drift{0.015, 0.0007};
  const Figures whole = after_the_ride(kEndless, drift, 80), parts = after_the_ride(25, drift, 80);
  RecordProperty("whole", std::to_string(whole.doubled) + ", " + std::to_string(whole.late_m) + " m");
  RecordProperty("parts", std::to_string(parts.doubled) + ", " + std::to_string(parts.late_m) + " m");
  EXPECT_EQ(whole.submaps, 2U);
  EXPECT_GT(parts.submaps, 6U);
  EXPECT_GT(whole.doubled, 2 * parts.doubled);
  EXPECT_LT(parts.doubled, 0.025);
  EXPECT_LT(parts.late_m, 0.7 * whole.late_m);
}

}  // namespace
}  // namespace cairn::team
