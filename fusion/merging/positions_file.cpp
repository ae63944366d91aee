// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/positions_file.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/bytes.hpp"
#include "hal/files/file.hpp"

namespace cairn::merging {

Result<void> save_positions(std::span<const VoxelPosition> voxels, const std::filesystem::path& path) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(voxels.size()) + "\n";
  for (const char* name : {"x", "y", "z", "sigma_x", "sigma_y", "sigma_z"})
    header += std::string("property float ") + name + "\n";
  header += "property uchar maps\nend_header\n";
  const auto text = std::as_bytes(std::span(header));
  std::vector<std::byte> out(text.begin(), text.end());
  for (const VoxelPosition& voxel : voxels) {
    for (const double coordinate : voxel.position.mean) append_le(out, static_cast<float>(coordinate));
    for (const double variance : voxel.position.covariance.diagonal())
      append_le(out, static_cast<float>(std::sqrt(variance)));
    append_le(out, static_cast<std::uint8_t>(voxel.maps));
  }
  return write_file_atomic(path, out);
}

}  // namespace cairn::merging
