// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/projection/recorded_lidar.hpp"

#include <utility>

#include "drivers/recording/formats/scan_file.hpp"
#include "drivers/velodyne/lidar.hpp"

namespace cairn::cli {

std::optional<std::size_t> lidar_of(const recording::Recording& recording) {
  for (std::size_t i = recording.sources.size(); i-- > 0;)
    if (recording.sources[i].kind == recording::kVelodyne || recording.sources[i].kind == recording::kScans) return i;
  return {};
}

Result<std::unique_ptr<ScanDecoder>> decoder_of(const recording::SourceEntry& entry, SourceId id,
                                                const app::RobotProfile& profile, Monitor& monitor) {
  if (entry.kind == recording::kScans)
    return std::unique_ptr<ScanDecoder>(std::make_unique<recording::ScanFileDecoder>(entry.deskewed));
  auto lidar = velodyne::Lidar::create(profile.lidar.driver, id, monitor);
  if (!lidar) return lidar.error();
  return std::unique_ptr<ScanDecoder>(*std::move(lidar));
}

}  // namespace cairn::cli
