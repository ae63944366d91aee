// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "fusion/merging/voxel_positions.hpp"
#include "hal/result.hpp"

namespace cairn::merging {

/// Binary little-endian PLY. For each voxel: x, y, z and their standard deviations sigma_x, sigma_y, sigma_z (m), and
/// `maps`, the number of maps that know it. Error kIo.
Result<void> save_positions(std::span<const VoxelPosition> voxels, const std::filesystem::path& path);

}  // namespace cairn::merging
