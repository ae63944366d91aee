// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/team_people.hpp"

namespace cairn::app {

peers::Bodies bodies_of(const TileBatch& batch, const TeamProfile& profile) {
  const SE3& T = batch.T_odom_base.mean;
  peers::Bodies bodies;
  bodies.robot = {.position_m = T.translation(),
                  .velocity_m_s = (T.rotation() * batch.twist.head<3>()).head<2>(),
                  .radius_m = profile.body_radius_m,
                  .height_m = profile.body_height_m};
  for (const people::Person& p : batch.people) {
    peers::Bodies::Person& told = bodies.people.emplace_back();
    told.id = p.id;
    told.position_m << p.position, static_cast<double>(p.ground);
    told.velocity_m_s = p.velocity;
    told.covariance = p.covariance;
  }
  return bodies;
}

PeopleNews news_of(const team::PeerBodies& peer, std::uint32_t epoch, Time now) {
  PeopleNews news{.robot = peer.robot, .stamp = now, .epoch = epoch, .people = {}};
  for (const peers::Bodies::Person& p : peer.people) {
    people::Person& told = news.people.emplace_back();
    told.id = p.id;
    told.stamp = now;
    told.position = p.position_m.head<2>();
    told.ground = static_cast<float>(p.position_m.z());
    told.velocity = p.velocity_m_s;
    told.covariance = p.covariance;
    told.seen = true;
  }
  return news;
}

}  // namespace cairn::app
