// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/time.hpp"

namespace cairn::peers {

/// Periods, limits and the data rate of the exchange with peers.
struct ExchangeConfig {
  std::size_t bytes_per_second = 8000;  ///< of all that is sent, overhead included; up to one second's may gather
  Duration hello_period = std::chrono::seconds(1);          ///< between two hellos to a peer
  Duration announcement_period = std::chrono::seconds(10);  ///< between two to everyone, once a peer is known
  Duration digest_period = std::chrono::seconds(1);         ///< between two, of the robots with news
  Duration digest_repeat = std::chrono::seconds(3);         ///< between two of all robots
  Duration lease = std::chrono::seconds(3);                 ///< a peer that was not heard for so long is lost
  Duration longest_way = std::chrono::seconds(2);           ///< there and back; what takes longer counts as lost
  Duration answer = std::chrono::milliseconds(200);         ///< a robot takes so long to answer
  Duration gather = std::chrono::milliseconds(300);         ///< items wait so long for others to fill a datagram
  std::size_t overhead_bytes = 100;                         ///< of RTPS, UDP and IP for each datagram
  std::size_t max_bytes_per_robot = std::size_t{64} << 20;  ///< of memory, for the tiles of each robot: see memory_of()
  std::size_t spare_bytes = std::size_t{768} << 20;         ///< for robots that need more, together
  std::size_t max_robots = 16;                              ///< more are not listened to
  std::uint32_t voxel_um = 0;  ///< voxels of this robot's map, micrometres; peers with others are ignored; 0: any
};

}  // namespace cairn::peers
