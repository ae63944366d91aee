// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fusion/peers/items/item.hpp"
#include "hal/bytes.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::peers {

/// Where a robot is, and the people around it, at one instant, in its odom frame. No picture goes with it. It is void a
/// second or two later, so a lost one is not sent again.
struct Bodies {
  static constexpr std::size_t kMost = 24;                            ///< people; of more, the first
  static constexpr Duration kLife = std::chrono::milliseconds(1500);  ///< what is older says nothing
  static constexpr double kFastest = 50;                              ///< m/s
  static constexpr double kWidest = 10;                               ///< m, of a robot

  /// Somebody whom the robot follows.
  struct Person {
    std::uint32_t id = 0;                                      ///< of the robot that follows; never 0
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();      ///< the ground below the body's middle
    Eigen::Vector2d velocity_m_s = Eigen::Vector2d::Zero();    ///< m/s
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of x and y, m²
  };
  /// The robot itself, as an upright cylinder.
  struct Robot {
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();    ///< of base_link
    Eigen::Vector2d velocity_m_s = Eigen::Vector2d::Zero();  ///< m/s
    double radius_m = 0, height_m = 0;                       ///< height above base_link
  };

  Epoch epoch = 0;  ///< of the odom frame
  Time stamp{};     ///< the sender's clock: orders what one robot says
  Duration age{};   ///< how old it was when it was sent
  Robot robot;
  std::vector<Person> people;  ///< in ascending order of ids
};

/// Appends it, in centimetres, cm/s and cm², as varints. What is no number or out of bounds becomes the nearest bound.
void append_bodies(std::vector<std::byte>& out, const Bodies& bodies);
/// Reads what append_bodies() can have written, and nothing else. Error: kMalformed.
[[nodiscard]] Result<Bodies> read_bodies(ByteReader& in);

}  // namespace cairn::peers
