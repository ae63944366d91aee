// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/join_team.hpp"

#include "drivers/peers/peer_port.hpp"

namespace cairn::app {
Result<void> check_team_place(const RobotProfile& profile) {
  if (profile.team.id != 0) return {};
  return Error{Errc::kInvalidConfig,
               "this robot has no place in a team",
               profile.name,
               {},
               "give it a number of its own in its profile: team: {id: 1}"};
}

recording::SourceEntry peers_entry() {
  recording::SourceEntry entry;
  entry.id = to_string(recording::kPeers);
  entry.kind = recording::kPeers;
  entry.file = "peers.log";
  return entry;
}

Result<void> join_team(const RobotProfile& profile, const Clock& clock, Door& door) {
  if (auto place = check_team_place(profile); !place) return place;
  forget_recorded(recording::kPeers, door);
  const recording::SourceEntry entry = peers_entry();
  const auto id = static_cast<SourceId>(door.inputs.size());
  const Time utc = clock.now() + Duration{LiveClock::realtime_offset()};
  const peer_link::Beginning beginning{static_cast<peers::RobotId>(profile.team.id), new_epoch(utc)};
  auto port = peer_link::PeerPort::open(profile.team.socket, beginning, id, clock);
  if (!port) return at(entry.id, port.error());
  Input input{entry, nullptr, {}, nullptr, nullptr, {}};
  input.peers = port->get();
  input.source = std::move(*port);
  door.inputs.push_back(std::move(input));
  door.recording.sources.push_back(entry);
  return {};
}

}  // namespace cairn::app
