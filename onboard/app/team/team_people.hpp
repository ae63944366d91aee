// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/team/peer_bodies.hpp"
#include "onboard/app/profile/team_profile.hpp"
#include "onboard/app/streams/outlets/stream_outlets.hpp"
#include "onboard/app/team/team_messages.hpp"

namespace cairn::app {

/// What peers are told: where the robot is, and people around it.
[[nodiscard]] peers::Bodies bodies_of(const TileBatch& batch, const TeamProfile& profile);

/// What clients are told of a peer's people, in this robot's odom. `epoch`: of that odom.
[[nodiscard]] PeopleNews news_of(const team::PeerBodies& peer, std::uint32_t epoch, Time now);

}  // namespace cairn::app
