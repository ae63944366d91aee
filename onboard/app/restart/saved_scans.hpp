// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.hpp"
#include "onboard/odometry/recent_scans.hpp"

namespace cairn::app {

/// The scans of one epoch of a map, for odometry to start again with.
struct SavedScans {
  std::uint32_t epoch = 0;
  std::vector<odometry::PlacedScan> scans;
};

/// "CAIRNSCN", version, epoch, number of scans; for each scan stamp, pose (x y z qx qy qz qw), number of points and the
/// points; at the end XXH3-64 of everything before. Little-endian.
[[nodiscard]] std::vector<std::byte> encode(const SavedScans& saved);
/// Errors: kMalformed, kTruncated, kLimit (more scans than RecentScans keeps). Poses and points are finite,
/// quaternions of unit length.
Result<SavedScans> decode_scans(std::span<const std::byte> bytes);

}  // namespace cairn::app
