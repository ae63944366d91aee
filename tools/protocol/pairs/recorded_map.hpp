// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "drivers/recording/formats/sensor_kind.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/mapping_config.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::protocol {

/// The part of a simulated recording that becomes a map.
struct Portion {
  recording::SensorKind kind{};    ///< of source: recording::kVelodyne or recording::kDepth
  double from_s = 0, to_s = 3600;  ///< since the recording's first true pose
  int every = 1;                   ///< every so many scans
};

/// T_world_base when the recording begins, from its ground_truth.tum.
[[nodiscard]] Result<SE3> first_true_pose(const std::filesystem::path& recording);

/// The map that Cairn's decoders and mapper make of a recording, with the true pose of base_link
/// for each point. Odometry has no part in it, so that the errors of a match are the matcher's own.
/// `T_map_world` says where the map's frame lies. Errors: those of the files; kNotFound without a
/// source of the kind; kMalformed without ground truth.
[[nodiscard]] Result<std::shared_ptr<mapping::SemanticOcTree>> map_of_recording(const std::filesystem::path& recording,
                                                                                const Portion& portion,
                                                                                const SE3& T_map_world,
                                                                                const mapping::MappingConfig& config);

}  // namespace cairn::protocol
