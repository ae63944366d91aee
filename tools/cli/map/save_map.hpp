// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::cli {

/// What is wrong with a file name for save_map(): kInvalidConfig, so that it counts as a wrong argument.
Result<void> check_map_name(const std::filesystem::path& path);
/// Writes the map in the format that the name's extension asks for: .cairn, .ot, .bt, .ply or .pcd.
Result<void> save_map(const mapping::SemanticOcTree& map, const std::filesystem::path& path);

}  // namespace cairn::cli
