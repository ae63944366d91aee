// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/join_team.hpp"

#include <algorithm>

#include "drivers/peers/peer_port.hpp"

namespace cairn {
namespace {

/// What peers said when a recording was made is not what they say now.
void forget_recorded_peers(Door& door) {
  for (std::size_t i = door.inputs.size(); i-- > 0;) {
    if (door.inputs[i].entry.kind != recording::kPeers) continue;
    door.inputs.erase(door.inputs.begin() + static_cast<std::ptrdiff_t>(i));
    door.recording.sources.erase(door.recording.sources.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

Result<void> join_team(const RobotProfile& profile, const Clock& clock, Door& door) {
  if (profile.team.id == 0)
    return Error{Errc::kInvalidConfig,
                 "this robot has no place in a team",
                 profile.name,
                 {},
                 "give it a number of its own in its profile: team: {id: 1}"};
  forget_recorded_peers(door);
  recording::SourceEntry entry;
  entry.id = entry.kind = recording::kPeers;
  entry.file = "peers.log";
  const auto id = static_cast<SourceId>(door.inputs.size());
  const Time utc = clock.now() + Duration{LiveClock::realtime_offset()};
  const peers::Beginning beginning{static_cast<peers::RobotId>(profile.team.id), new_epoch(utc)};
  auto port = peers::PeerPort::open(profile.team.socket, beginning, id, clock);
  if (!port) return at(entry.id, port.error());
  Input input{entry, nullptr, {}, nullptr, nullptr, {}};
  input.peers = port->get();
  input.source = std::move(*port);
  door.inputs.push_back(std::move(input));
  door.recording.sources.push_back(entry);
  return {};
}

}  // namespace cairn
