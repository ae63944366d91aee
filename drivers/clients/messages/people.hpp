// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "drivers/clients/messages/record.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// The people around a robot, as one scan shows them. A message without anybody says that nobody is known. Peers tell
/// of theirs some two times a second; their places are in the odom frame of the robot that is asked, predicted to
/// `stamp`.
struct PeopleMessage {
  static constexpr RecordKind kKind = RecordKind::kPeople;
  static constexpr std::size_t kMost = 256;  ///< people

  /// One of them.
  struct Person {
    std::uint32_t id = 0;         ///< of the robot that follows; never used again in one run
    std::uint32_t sightings = 0;  ///< pictures in which a detector saw this person; 0: only the LiDAR did
    bool seen = false;            ///< in this scan; otherwise the place is predicted
    Eigen::Vector3d position_odom = Eigen::Vector3d::Zero();  ///< the ground below the body's middle, m
    Eigen::Vector2d velocity_odom = Eigen::Vector2d::Zero();  ///< m/s
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();     ///< of x and y, m²
  };
  Time stamp{};             ///< robot time: of the scan's end
  std::uint32_t epoch = 0;  ///< see PoseMessage
  std::uint64_t robot = 0;  ///< the peer who follows them; 0: the robot that is asked
  std::vector<Person> people;
};

/// Appends the body. It is: stamp (8), epoch (4), count (4), robot (8), then for each person id (4), sightings (4),
/// flags (4; bit 0 seen), zero (4), x y z (8 each), vx vy (8 each), variances of x, of x and y, of y (8 each). People
/// beyond kMost are left out.
void encode(const PeopleMessage& message, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<PeopleMessage> decode_people(std::span<const std::byte> body);

}  // namespace cairn::clients
