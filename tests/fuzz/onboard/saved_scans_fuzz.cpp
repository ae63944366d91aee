// SPDX-License-Identifier: Apache-2.0
// Any bytes in place of saved scans, once as they are and once with the checksum that makes them be read: an error, or
// finite poses and points that survive being written.
#include <xxhash.h>

#include <span>
#include <vector>

#include "hal/bytes.hpp"
#include "onboard/app/restart/saved_scans.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  const auto bytes = std::as_bytes(std::span(data, size));
  (void)app::decode_scans(bytes);
  std::vector<std::byte> sealed(bytes.begin(), bytes.end());
  append_le<std::uint64_t>(sealed, XXH3_64bits(sealed.data(), sealed.size()));
  const auto saved = app::decode_scans(sealed);
  if (!saved) return 0;
  require(saved->scans.size() <= odometry::RecentScans::kScans);
  for (const odometry::PlacedScan& scan : saved->scans) {
    require(scan.T_odom_base.matrix().allFinite());
    for (const auto& point : scan.points_base) require(point.allFinite());
  }
  const auto again = app::decode_scans(app::encode(*saved));
  require(again.has_value() && again->epoch == saved->epoch && again->scans.size() == saved->scans.size());
  return 0;
}
