// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/peer_bodies.hpp"

namespace cairn::team {
namespace {

using peers::Bodies;

constexpr double kAcceleration = 1.5;  // m/s², 1 σ: people turn and stop; as a track has it

Eigen::Vector3d moved(const Eigen::Vector3d& position, const Eigen::Vector2d& velocity, double dt_s) {
  return position + dt_s * Eigen::Vector3d(velocity.x(), velocity.y(), 0);
}

Eigen::Vector2d turned(const SE3& T, const Eigen::Vector2d& v) {
  return (T.rotation() * Eigen::Vector3d(v.x(), v.y(), 0)).head<2>();
}

Bodies::Person placed(const Bodies::Person& person, const SE3& T, double dt_s) {
  const Eigen::Matrix2d R = T.rotation().topLeftCorner<2, 2>();
  const double grown = 0.5 * kAcceleration * dt_s * dt_s;
  return {.id = person.id,
          .position_m = T * moved(person.position_m, person.velocity_m_s, dt_s),
          .velocity_m_s = turned(T, person.velocity_m_s),
          .covariance = R * person.covariance * R.transpose() + grown * grown * Eigen::Matrix2d::Identity()};
}

PeerBodies placed(peers::RobotId robot, const peers::Link::Heard& heard, const SE3& T_own_peer, Time now) {
  const double dt_s = to_seconds(now - heard.seen);
  const Bodies::Robot& body = heard.bodies.robot;
  PeerBodies out{.robot = robot,
                 .age = now - heard.seen,
                 .body = {.position_m = T_own_peer * moved(body.position_m, body.velocity_m_s, dt_s),
                          .velocity_m_s = turned(T_own_peer, body.velocity_m_s),
                          .radius_m = body.radius_m,
                          .height_m = body.height_m},
                 .people = {}};
  for (const Bodies::Person& person : heard.bodies.people) out.people.push_back(placed(person, T_own_peer, dt_s));
  return out;
}

}  // namespace

std::vector<PeerBodies> bodies_of_peers(const peers::Exchange& exchange,
                                        const std::map<peers::RobotId, SE3>& T_team_odom, Time now) {
  std::vector<PeerBodies> all;
  const auto own = T_team_odom.find(exchange.self());
  if (own == T_team_odom.end()) return all;
  for (const auto& [robot, link] : exchange.links()) {
    const auto other = T_team_odom.find(robot);
    if (!link.bodies || other == T_team_odom.end() || now - link.bodies->seen > Bodies::kLife) continue;
    if (link.bodies->bodies.epoch != link.epoch || !exchange.alike(link)) continue;
    all.push_back(placed(robot, *link.bodies, own->second.inverse() * other->second, now));
  }
  return all;
}

}  // namespace cairn::team
