// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/status_messages.hpp"

#include <algorithm>

#include "fusion/peers/datagrams/datagram_part.hpp"

namespace cairn::peers {

Datagram StatusMessages::announcement() const {
  return {.sender = self_.id, .hello = hello(0), .digest = digest_of_all(), .items = {}};
}

Datagram StatusMessages::status(RobotId peer, const Link& link) const {
  Datagram status{.sender = self_.id, .hello = hello(peer), .digest = {}, .items = {}};
  if (now_ >= link.next_digest) status.digest = now_ >= link.next_full ? digest_of_all() : digest_of(link.owed);
  return status;
}

Datagram StatusMessages::companion(RobotId peer, const Link& link) const {
  const Datagram alone{.sender = self_.id, .hello = {}, .digest = {}, .items = {}};
  Datagram datagram = alone;
  if (now_ + config_.hello_period / 2 >= link.next_status)
    datagram = status(peer, link);
  else
    datagram.digest = digest_of(link.owed);
  Datagram digest = alone;
  digest.digest = datagram.digest;
  return encode(digest).bytes.size() <= kHeaderBytes + kMaxRangeBytes ? datagram : alone;
}

std::optional<Datagram> StatusMessages::bodies(Time told) const {
  if (!self_.bodies || self_.bodies->stamp <= told || now_ - self_.bodies->stamp > Bodies::kLife) return std::nullopt;
  Datagram datagram{.sender = self_.id, .hello = {}, .digest = {}, .items = {}, .bodies = self_.bodies};
  datagram.bodies->epoch = layers_.own().epoch;
  datagram.bodies->age = std::max(Duration{}, now_ - self_.bodies->stamp);
  return datagram;
}

/// The peer can tell the difference of the clocks from it, if it was heard.
Hello StatusMessages::hello(RobotId peer) const {
  const Layer& own = layers_.own();
  Hello hello{.epoch = own.epoch,
              .newest = own.holding.newest(),
              .stamp = now_,
              .name = self_.name,
              .echo = {},
              .voxel_um = config_.voxel_um,
              .place = self_.place};
  const auto link = links_.all().find(peer);
  if (link != links_.all().end() && link->second.echo.stamp != Time::min())
    hello.echo = {.robot = peer, .stamp = link->second.echo.stamp, .age = now_ - link->second.echo_heard};
  return hello;
}

void StatusMessages::add(Digest& digest, RobotId robot, const Layer& layer) const {
  digest.layers.push_back(
      {.robot = robot, .epoch = layer.epoch, .direct = links_.hears(robot, now_), .known = layer.holding.known()});
}

Digest StatusMessages::digest_of(const std::set<RobotId>& robots) const {
  Digest digest;
  for (const auto& [robot, layer] : layers_.all())
    if (robots.contains(robot)) add(digest, robot, layer);
  return digest;
}

/// Also of robots that are heard, and of which nothing is known yet.
Digest StatusMessages::digest_of_all() const {
  Digest digest;
  for (const auto& [robot, layer] : layers_.all()) add(digest, robot, layer);
  for (const auto& [robot, link] : links_.all())
    if (links_.hears(robot, now_) && !layers_.all().contains(robot))
      digest.layers.push_back({.robot = robot, .epoch = 0, .direct = true, .known = {}});
  return digest;
}

}  // namespace cairn::peers
