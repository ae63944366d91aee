// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::app {

/// What a run needs of the previous one besides its map. As text it has at most 1 KB, one line each:
///
///     cairn-state 1
///     sequence 12              counts saved generations
///     epoch 3                  counts new beginnings of the map: poses of two epochs have nothing in common
///     boot 5f1c…               of the machine: stamps of two boots cannot be compared
///     stamp_ns 123456789
///     pose x y z qx qy qz qw   T_odom_base
///     twist vx vy vz wx wy wz  of base_link in base_link: m/s, rad/s
///     covariance …             36 numbers, row by row, of the pose's right perturbation
struct SavedState {
  std::uint64_t sequence = 0;
  std::uint32_t epoch = 0;
  std::string boot;  ///< letters, digits, dashes; 64 at most
  Time stamp{};
  UncertainPose T_odom_base;
  Vector6 twist = Vector6::Zero();
};

/// Numbers have the fewest digits that read back to the same bits.
[[nodiscard]] std::string to_text(const SavedState& state);
/// Errors: kMalformed with the line's name; every number is finite and the quaternion of unit length.
[[nodiscard]] Result<SavedState> parse_state(std::string_view text);

}  // namespace cairn::app
