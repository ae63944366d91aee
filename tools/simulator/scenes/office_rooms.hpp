// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/simulator/scenes/furniture.hpp"

namespace cairn::simulator::scenes {

enum class RoomKind : std::uint8_t { kTwoDesks, kFourDesks, kMeeting, kStore, kLounge };

/// A rectangular room with one door, in the frame of its door wall: origin in the middle of that wall on the floor,
/// x into the room, y along the wall.
struct Room {
  Placement door_wall;
  double width = 5.0;     ///< along y
  double depth = 6.0;     ///< along x
  double door_at = 0;     ///< y of the door's centre
  double door_angle = 0;  ///< how far the leaf stands open, radians; 0 = closed
  RoomKind kind = RoomKind::kTwoDesks;
};

inline constexpr double kDoorWidth = 1.2, kDoorHead = 2.1;

/// Door frame, leaf and furniture. Leaves the way from the door to `standing_place` free.
void furnish(Mesh& mesh, const Room& room);
/// Where a robot can stand and turn, in the world.
[[nodiscard]] Eigen::Vector2d standing_place(const Room& room);

}  // namespace cairn::simulator::scenes
