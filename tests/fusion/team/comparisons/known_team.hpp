// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "fusion/matching/evidence/judge.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "fusion/team/comparisons/team_view.hpp"

namespace cairn::team {

/// What robot 1 knows of its team, put together by hand.
struct KnownTeam {
  static constexpr peers::Epoch kEpoch = peers::Epoch{1} << 32U;
  static constexpr double kResolution_m = 0.2;

  peers::Exchange exchange{1, "robot_1", kEpoch};
  TeamTiles tiles;
  TeamPoses poses;
  SubmapChains chains;

  [[nodiscard]] TeamView view() const {
    return {.exchange = exchange, .tiles = tiles, .poses = poses, .chains = chains, .resolution_m = kResolution_m};
  }

  /// A robot publishes an item; this robot receives it at once.
  void publish(peers::RobotId robot, peers::ItemId id, const std::vector<std::byte>& payload,
               peers::Epoch epoch = kEpoch) {
    if (robot == exchange.self()) return void(exchange.say(id, payload));
    const peers::ItemUpdate update{.id = id, .version = ++versions_[{robot, epoch}], .payload = payload};
    const peers::Datagram datagram{
        .sender = robot,
        .hello = {},
        .digest = {},
        .items = peers::Items{.robot = robot, .epoch = epoch, .superseded = {}, .updates = {update}}};
    (void)exchange.receive(peers::encode(datagram).bytes, Time{});
  }

  /// A robot publishes a row of tiles with a wall each, along x from `first`, in one of its submaps.
  void publish_walls(peers::RobotId robot, std::uint16_t submap, int first, int count) {
    mapping::TileState wall;
    for (unsigned i = 0; i < 64; ++i) wall.set(i % 8, 3, i / 8, 2);
    std::vector<std::byte> payload;
    peers::encode_tile(wall, payload);
    for (int x = first; x < first + count; ++x) {
      publish(robot, peers::ItemId::tile(submap, tile_at(x)), payload);
      (void)tiles.put(robot, tile_at(x), submap, true);
    }
  }
  static mapping::TileKey tile_at(int x) {
    return mapping::TileKey::of_voxel(static_cast<std::uint16_t>(32768 + 8 * x), 32768, 32768);
  }

  /// A robot publishes where it was put down, with standard deviations of position and attitude.
  void deploy(peers::RobotId robot, const SE3& T_site_odom, double sigma_m, double sigma_rad) {
    publish(robot, peers::ItemId::deployment(), encode(peers::Deployment{pose(T_site_odom, sigma_m, sigma_rad)}));
  }
  static UncertainPose pose(const SE3& T, double sigma_m, double sigma_rad) {
    Vector6 sigma;
    sigma << Eigen::Vector3d::Constant(sigma_m), Eigen::Vector3d::Constant(sigma_rad);
    return {T, sigma.cwiseAbs2().asDiagonal()};
  }
  static SE3 at(double x, double y, double yaw = 0) {
    return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished());
  }

 private:
  std::map<std::pair<peers::RobotId, peers::Epoch>, peers::Version> versions_;
};

/// A look at a place that agrees as well as the truth does, on so much ground.
inline matching::Look agreeing(const SE3& T_a_b, double ground_m2 = 300) {
  matching::Look look{.T_a_b = {T_a_b, 1e-4 * Matrix6::Identity()}, .evidence = {}};
  look.evidence.structure_inliers = 0.8;
  look.evidence.agreeing_floor_m2 = 80;
  look.evidence.agreeing_m2 = ground_m2;
  look.evidence.weakest_translation = 0.4;
  look.evidence.reverse_conflict = 0.005;
  look.evidence.score = 0.6;
  return look;
}
/// A look at a place that the maps contradict.
inline matching::Look contradicting(const SE3& T_a_b) {
  matching::Look look = agreeing(T_a_b);
  look.evidence.conflict = 0.2;
  look.evidence.score = 0.05;
  return look;
}

}  // namespace cairn::team
