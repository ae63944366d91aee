// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/client/robot_stream.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// People as rviz shows them: for each a cylinder, an arrow along one second of walking, and the number. The first
/// marker removes all of before. People whom no camera has seen are grey; who is hidden is faint.
///
/// People of a teammate have namespaces with its id, such as `people_3`. They share a topic with those of others, so
/// nothing is removed: who is told of no more fades within 2 s.
[[nodiscard]] MarkerArray markers_of(const client::PeopleMessage& people, const Header& header, Arena& arena);

}  // namespace cairn::ros
