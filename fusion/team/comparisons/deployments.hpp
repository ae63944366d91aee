// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fusion/matching/belief/pending.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/team/comparisons/compared_peers.hpp"
#include "fusion/team/comparisons/team_view.hpp"
#include "fusion/team/graph/indexed_edge.hpp"
#include "hal/se3.hpp"

// Where robots say that they were put down. It is a guess for the comparison of their maps. If it is
// exact, it also places the two until the maps themselves do. It may be wrong: the maps have the last
// word. But firm ones are not overruled: maps that contradict a person, or satellites, are not merged.
namespace cairn::team {

/// Where b's odom frame lies in a's by the deployments of both; nothing if they do not lead to one frame.
[[nodiscard]] std::optional<UncertainPose> deployed_between(const peers::Layers& layers, peers::RobotId a,
                                                            peers::RobotId b);

/// How firm the deployments of the two are: see peers::Deployment::firm. 0: a guess, or nothing is known between them.
[[nodiscard]] std::uint64_t firmness(const peers::Layers& layers, peers::RobotId a, peers::RobotId b);

/// Whether the maps contradict the deployments: they have dropped that place, or agree with another.
[[nodiscard]] bool refutes(const matching::PendingHypotheses& places, const UncertainPose& T_own_peer);

/// The edges to be published for deployments that are exact: within a voxel and half a degree of yaw.
/// They are withdrawn, with probability 0, when a comparison has found the peer or refutes them.
/// Only the lower of two robots publishes one.
[[nodiscard]] std::vector<IndexedEdge> deployment_edges(const TeamView& team, ComparedPeers& compared);

/// Firm deployments are heeded from now on: see ComparedPeers::heed(). Returns the edges to be published.
[[nodiscard]] std::vector<IndexedEdge> heed_firm(const TeamView& team, ComparedPeers& compared);

/// How the deployments of this robot and a peer contradict what is known, for people. It begins with
/// a semicolon. Empty if they do not, or if there are none.
[[nodiscard]] std::string deployment_fault(const TeamView& team, const ComparedPeer* compared, peers::RobotId peer);

}  // namespace cairn::team
