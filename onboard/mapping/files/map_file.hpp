// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "hal/result.hpp"
#include "onboard/mapping/files/cairn_file.hpp"
#include "onboard/mapping/files/octomap_file.hpp"
#include "onboard/mapping/files/point_file.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Reads .cairn, .ot or .bt; the content decides, not the name. Safe on hostile files.
Result<std::unique_ptr<SemanticOcTree>> load_map(const std::filesystem::path& path, const MapLimits& limits = {});

// All of them replace the file atomically: after a crash or a full disk there is the old content or the new.
Result<void> save_cairn(const SemanticOcTree& tree, const std::filesystem::path& path, std::string_view metadata = {});
Result<void> save_ot(const SemanticOcTree& tree, const std::filesystem::path& path);
Result<void> save_bt(const SemanticOcTree& tree, const std::filesystem::path& path);
/// Occupied voxel centres; the .ply has the colours of the classes where the map has labels.
Result<void> save_ply(const SemanticOcTree& tree, const std::filesystem::path& path);
Result<void> save_pcd(const SemanticOcTree& tree, const std::filesystem::path& path);

}  // namespace cairn::mapping
