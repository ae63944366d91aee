// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "fusion/team/team.hpp"
#include "hal/workers.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::fleet {

/// What odometry makes of each metre that was driven.
struct Drift {
  double scale = 0;          ///< of the way, too much
  double yaw_per_metre = 0;  ///< rad
};

/// A robot of a team that rides through a scene and maps it; ranges have 2 cm noise, poses are exact but for its drift.
/// Its odom frame is that of its start, turned by `yaw`.
class RidingRobot {
 public:
  RidingRobot(const team::TeamConfig& config, const support::Scene& scene, double from, double yaw,
              const Drift& drift = {})
      : team(config, std::uint64_t{1} << 32U),
        scene_(scene),
        phi_(from),
        drift_(drift),
        lidar_(mount(), 0.02, static_cast<unsigned>(config.id)),
        mapper_(mapping(config.resolution_m), workers_) {
    Vector6 turned;
    turned << 0.037, -0.021, 0.03, 0, 0, yaw;
    T_odom_world_ = SE3::from_xyz_rpy(turned) * support::pose_on(scene.ride, from).inverse();
  }

  /// Goes on by `dphi` of the ride's curve and takes a scan there.
  void ride(double dphi, Time now) {
    const SE3 was = support::pose_on(scene_.ride, phi_);
    phi_ += dphi;
    const SE3 at = support::pose_on(scene_.ride, phi_);
    T_odom_world_ = T_odom_world_ * was * drifted(was.inverse() * at) * at.inverse();
    team.be_at({T_odom_world_ * at, Matrix6::Identity() * 1e-4});
    const Scan scan = lidar_.scan(
        scene_.world, [&](double) { return at; }, 0);
    const SE3 T_odom_lidar = T_odom_world_ * at * mount();
    points_.clear();
    for (const Eigen::Vector3f& p : scan.cloud.xyz)
      points_.emplace_back((T_odom_lidar * p.cast<double>()).cast<float>());
    (void)mapper_.insert(points_, T_odom_lidar.translation().cast<float>());
    for (const mapping::TileKey tile : mapper_.take_changed_tiles())
      team.observe(tile, mapping::read_tile(mapper_.tree(), tile), now);
    team.judge(false, now);
  }

  /// From now on, odometry is wrong by so much, and does not know it: a motion of base_link.
  void mislead(const SE3& motion) {
    const SE3 at = T_world_base();
    T_odom_world_ = T_odom_world_ * at * motion * at.inverse();
  }

  /// Where the robot is in the world.
  [[nodiscard]] SE3 T_world_base() const { return support::pose_on(scene_.ride, phi_); }
  /// By now.
  [[nodiscard]] const SE3& T_odom_world() const { return T_odom_world_; }
  [[nodiscard]] const mapping::SemanticOcTree& map() const { return mapper_.tree(); }

  team::Team team;

 private:
  [[nodiscard]] SE3 drifted(const SE3& moved) const {
    if (drift_.scale == 0 && drift_.yaw_per_metre == 0) return moved;
    const double turned = drift_.yaw_per_metre * moved.translation().norm();
    const Eigen::AngleAxisd yaw(turned, Eigen::Vector3d::UnitZ());
    return {moved.quaternion() * Eigen::Quaterniond(yaw), (1 + drift_.scale) * moved.translation()};
  }
  static SE3 mount() {
    Vector6 v;
    v << 0.2, 0, 0.6, 0, 0, 0;
    return SE3::from_xyz_rpy(v);
  }
  static mapping::MappingConfig mapping(double resolution_m) {
    mapping::MappingConfig config;
    config.resolution_m = resolution_m;
    config.max_range_m = 12;
    return config;
  }

  support::Scene scene_;
  double phi_;
  Drift drift_;
  SE3 T_odom_world_;
  support::Vlp16 lidar_;
  Workers workers_{1};
  mapping::Mapper mapper_;
  std::vector<Eigen::Vector3f> points_;
};

}  // namespace cairn::fleet
