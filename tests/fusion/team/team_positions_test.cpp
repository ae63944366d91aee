// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/team_positions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "tests/fusion/team/two_teams.hpp"

namespace cairn::team {
namespace {

using std::chrono::milliseconds;

constexpr double kTile_m = 1.6, kSigma_rad = 0.02;
constexpr unsigned kTiles = 20, kApart = 10;
constexpr std::size_t kWalls = 64;  // occupied voxels of a tile
constexpr peers::Epoch kEpoch = peers::Epoch{1} << 32U;
constexpr float kLogOdds = 2.5F;  // a grade that robots exchange

mapping::TileState wall() {
  mapping::TileState wall;
  for (unsigned i = 0; i < kWalls; ++i) wall.set(i % 8, 3, i / 8, kLogOdds);
  return wall;
}

mapping::TileKey nth(unsigned i) {
  return mapping::TileKey::of_voxel(static_cast<std::uint16_t>(32768 + 8 * i), 32768, 32768);
}

/// A robot with a row of walls along x, and a peer with an equal one, so many tiles farther on.
class TeamPositions : public testing::Test {
 protected:
  TeamPositions() {
    std::vector<std::byte> bytes;
    peers::encode_tile(wall(), bytes);
    for (unsigned i = 0; i < kTiles; ++i) {
      robot_.observe(nth(i), wall(), now_);
      peer_.say(peers::ItemId::tile(0, nth(i)), bytes);
    }
  }

  /// The peer knows where it is but for a turn about the robot's origin.
  void merge() {
    UncertainPose T_peer_robot{SE3(Eigen::Quaterniond::Identity(), {-kTile_m * kApart, 0, 0}),
                               1e-8 * Matrix6::Identity()};
    T_peer_robot.covariance(5, 5) = kSigma_rad * kSigma_rad;
    peer_.say(peers::ItemId::edge(0), encode(peers::Edge{0, 1, kEpoch, 0, T_peer_robot, 0.999F}));
  }
  std::vector<merging::VoxelPosition> after_talking() {
    for (int i = 0; i < 300; ++i, now_ += milliseconds(100)) {
      std::vector<peers::Outgoing> of_robot, of_peer;
      robot_.step(now_, of_robot);
      peer_.send(now_, of_peer);
      for (const auto& datagram : of_robot) EXPECT_TRUE(peer_.receive(datagram.bytes, now_));
      for (const auto& datagram : of_peer) EXPECT_TRUE(robot_.receive(datagram.bytes, now_));
    }
    Budget all = Budget::steps(std::numeric_limits<int>::max());
    EXPECT_TRUE(robot_.fuse(all));
    return team_positions(robot_).value();
  }

  Time now_{std::chrono::seconds(100)};
  Team robot_{fleet::team_member(1), kEpoch};
  peers::Exchange peer_{2, "second", kEpoch, {.voxel_um = 200'000}};
  const double own_ = merging::voxel_covariance(1 / (1 + std::exp(-kLogOdds)), 0.2).trace();
};

TEST_F(TeamPositions, ARobotAloneKnowsItsVoxelsToTheirSize) {
  const auto positions = after_talking();
  EXPECT_EQ(positions.size(), kWalls * kTiles);
  for (const merging::VoxelPosition& voxel : positions) {
    EXPECT_EQ(voxel.maps, 1);
    EXPECT_NEAR(voxel.position.covariance.trace(), own_, 1e-6);
  }
}

TEST_F(TeamPositions, WhatThePeerAloneKnowsIsWorseTheFartherItIsFromWhereItsPlaceIsCertain) {
  merge();
  const auto positions = after_talking();
  ASSERT_EQ(positions.size(), kWalls * (kTiles + kApart));
  for (const merging::VoxelPosition& voxel : positions) {
    const double x_m = voxel.position.mean.x();
    EXPECT_EQ(voxel.maps, x_m > kApart * kTile_m && x_m < kTiles * kTile_m ? 2 : 1) << x_m;
    if (x_m < kTiles * kTile_m) continue;
    EXPECT_NEAR(voxel.position.covariance.trace(), own_ + std::pow(kSigma_rad * x_m, 2), 0.05 * own_) << x_m;
  }
}

TEST_F(TeamPositions, WhatBothKnowIsKnownBetterThanByEither) {
  merge();
  const mapping::PositionFigures figures = merging::position_figures(after_talking());
  EXPECT_EQ(figures.voxels, kWalls * (kTiles + kApart));
  EXPECT_EQ(figures.shared, kWalls * (kTiles - kApart));
  EXPECT_LT(figures.shared_mean_m, 0.95 * figures.shared_alone_m);
}

}  // namespace
}  // namespace cairn::team
