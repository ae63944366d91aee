// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/messages/people_message.hpp"

namespace cairn::app {

clients::PeopleMessage message_of(const PeopleNews& news) {
  clients::PeopleMessage message{.stamp = news.stamp, .epoch = news.epoch, .robot = news.robot, .people = {}};
  for (const people::Person& person : news.people) {
    auto& told = message.people.emplace_back();
    told.id = person.id;
    told.sightings = person.sightings;
    told.seen = person.seen;
    told.position_odom << person.position, person.ground;
    told.velocity_odom = person.velocity;
    told.covariance = person.covariance;
  }
  return message;
}

}  // namespace cairn::app
