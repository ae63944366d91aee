// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn::people {

// Heights above the ground, m.
inline constexpr float kAnkle = 0.08F;  ///< below, points are the ground's: feet share its voxels
inline constexpr float kShin = 0.25F;   ///< from here on, points tell where a body is
inline constexpr float kHead = 2.1F;    ///< above, nobody reaches

}  // namespace cairn::people
