// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.hpp"
#include "onboard/visual_odometry/place_memory.hpp"

namespace cairn::app {

/// The keyframes of one epoch of a map, for visual odometry to find the robot among.
struct SavedKeyframes {
  std::uint32_t epoch = 0;
  std::vector<visual_odometry::Keyframe> keyframes;
};

/// "CAIRNKEY", version, epoch, number of keyframes; for each keyframe stamp, pose (x y z qx qy qz qw), number of
/// landmarks, and for each of them its descriptor, place (m) and covariance (m²; xx xy xz yy yz zz); at the end XXH3-64
/// of everything before. Little-endian. A landmark's epoch of drift is left out: it means nothing to another run.
[[nodiscard]] std::vector<std::byte> encode(const SavedKeyframes& saved);
/// Errors: kMalformed, kLimit (more keyframes than PlaceMemory keeps). Poses and places are finite, quaternions of unit
/// length, covariances positive definite.
Result<SavedKeyframes> decode_keyframes(std::span<const std::byte> bytes);

}  // namespace cairn::app
