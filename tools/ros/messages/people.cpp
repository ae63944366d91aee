// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/people.hpp"

#include <cmath>
#include <span>
#include <string>

namespace cairn::ros {
namespace {

// visualization_msgs/msg/Marker.
constexpr std::int32_t kArrow = 0, kCylinder = 3, kText = 9;
constexpr std::int32_t kAdd = 0, kDeleteAll = 3;
constexpr std::size_t kMarkersEach = 3;
constexpr double kPersonHeight = 1.7, kPersonWidth = 0.5;  // m, as shown
constexpr std::int32_t kLifetime = 2;                      // s, should the core go
constexpr float kGrey = 0.6F;

using Person = client::PeopleMessage::Person;

Marker marker(std::int32_t type, const Person& person, const std::string& group, const Header& header, Arena& arena) {
  Marker m{};
  m.header = header;
  m.ns = arena.text(group);
  m.id = static_cast<std::int32_t>(person.id);
  m.type = type;
  m.action = kAdd;
  m.pose.orientation.w = 1;
  const float grey = person.sightings == 0 ? kGrey : 0.2F;
  m.color = {.r = person.sightings == 0 ? kGrey : 0.95F, .g = grey, .b = grey, .a = person.seen ? 0.8F : 0.3F};
  m.lifetime.sec = kLifetime;
  m.texture_resource = m.text = m.mesh_resource = arena.text("");
  m.texture.header.frame_id = m.texture.format = m.mesh_file.filename = m.text;
  return m;
}

Marker body_of(const Person& p, const std::string& of, const Header& header, Arena& arena) {
  Marker m = marker(kCylinder, p, "people" + of, header, arena);
  m.pose.position = {.x = p.position_odom.x(), .y = p.position_odom.y(), .z = p.position_odom.z() + kPersonHeight / 2};
  m.scale = {.x = kPersonWidth, .y = kPersonWidth, .z = kPersonHeight};
  return m;
}

/// From the middle of the body to where it is a second later.
Marker way_of(const Person& p, const std::string& of, const Header& header, Arena& arena) {
  Marker m = marker(kArrow, p, "velocities" + of, header, arena);
  m.scale = {.x = 0.06, .y = 0.12, .z = 0.12};
  const std::span points = arena.sequence(m.points, 2);
  points[0] = {.x = p.position_odom.x(), .y = p.position_odom.y(), .z = p.position_odom.z() + kPersonHeight / 2};
  points[1] = points[0];
  points[1].x += p.velocity_odom.x();
  points[1].y += p.velocity_odom.y();
  return m;
}

Marker number_of(const Person& p, const std::string& of, const Header& header, Arena& arena) {
  Marker m = marker(kText, p, "numbers" + of, header, arena);
  m.pose.position = {
      .x = p.position_odom.x(), .y = p.position_odom.y(), .z = p.position_odom.z() + kPersonHeight + 0.3};
  m.scale.z = 0.3;
  m.text = arena.text(std::to_string(p.id));
  return m;
}

}  // namespace

MarkerArray markers_of(const client::PeopleMessage& people, const Header& header, Arena& arena) {
  const bool own = people.robot == 0;
  const std::string of = own ? "" : "_" + std::to_string(people.robot);
  MarkerArray message{};
  const std::span markers = arena.sequence(message.markers, (own ? 1 : 0) + kMarkersEach * people.people.size());
  std::size_t next = 0;
  if (own) {
    markers[next] = marker(kCylinder, {}, "people", header, arena);
    markers[next++].action = kDeleteAll;
  }
  for (const Person& person : people.people) {
    markers[next++] = body_of(person, of, header, arena);
    markers[next++] = way_of(person, of, header, arena);
    markers[next++] = number_of(person, of, header, arena);
  }
  return message;
}

}  // namespace cairn::ros
